// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/leg_gate.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "estimator/legs/leg_velocity_model.hpp"

namespace aims {
namespace {

/// A longer innovation is not a slip.
constexpr Duration kMaxSlipDuration = 500 * kMillisecond;

}  // namespace

void describe(Fields& f, LegGateConfig& c) {
  f.flag("enabled", c.enabled, {"", any(), "leg samples weigh by their innovation"});
}

std::optional<double> gate_inflation(double distance) {
  const double factor = distance / kLegGate;
  if (!(factor <= kMaxVarianceGrowth)) return std::nullopt;
  return std::max(1.0, factor);
}

LegGate::LegGate(double rate_hz) : correlated_samples_(correlated_leg_samples(rate_hz)) {}

std::optional<double> LegGate::inflation(Time stamp, const LinearMeasurement& measurement,
                                         const ErrorMatrix& covariance) {
  // The gate uses the variance of a single sample, without the correlation factor. The uncertainty
  // of the leg states is left out, so that it does not hide a slip; a wrong scale lasts longer than
  // a slip and is accepted for that reason.
  Matrix3xError jacobian = measurement.jacobian;
  columns(jacobian, ErrorState::kLegScale).setZero();
  columns(jacobian, ErrorState::kLegBias).setZero();
  const Eigen::Matrix3d expected =
      jacobian * covariance * jacobian.transpose() + measurement.noise / correlated_samples_;
  const double distance = measurement.residual.dot(expected.llt().solve(measurement.residual));
  if (distance <= kLegGate) {
    outside_since_.reset();
    return 1.0;
  }
  if (!outside_since_) outside_since_ = stamp;
  if (stamp - *outside_since_ > kMaxSlipDuration) return 1.0;
  return gate_inflation(distance);
}

}  // namespace aims
