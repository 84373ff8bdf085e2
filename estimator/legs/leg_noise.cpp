// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/leg_noise.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Added with a single stance foot [m/s], per yaw rate [m] and per time without packets [m/s^2].
constexpr double kOneFootSigma = 0.05;
constexpr double kYawLever = 0.03;
constexpr double kGapGrowth = 0.1;

/// A longer innovation is not a slip.
constexpr Duration kMaxSlipDuration = 500 * kMillisecond;

double squared(double x) { return x * x; }

}  // namespace

void describe(Fields& f, LegNoiseConfig& c) {
  f.flag("enabled", c.enabled,
         {"", any(), "leg noise from stance feet, yaw rate, lost packets and innovation"});
  f.vector(
      "velocity_sigma", c.velocity_sigma,
      {"m/s", positive_up_to(1e3), "error of one sample with consistent stance feet, base axes",
       "docs/decisions.md#leg-noise-of-007-ms-per-sample"});
  f.number("nominal_spread", c.nominal_spread,
           {"m/s", up_to(1e3), "spread of the velocities from feet that do not slip",
            "docs/decisions.md#spread-of-the-feet-slips-only"});
}

StanceFeet compare_stance_feet(const LegOdometrySample& sample,
                               const Eigen::Vector3d& angular_velocity,
                               const LegGeometry& geometry) {
  StanceFeet feet;
  const Eigen::Map<const JointVector> position(sample.joint_position.data());
  const Eigen::Map<const JointVector> rate(sample.joint_velocity.data());
  feet.measured = position.allFinite() && rate.allFinite() && !position.isZero(0.0) &&
                  geometry != LegGeometry();
  if (!feet.measured) return feet;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (int leg = 0; leg < kLegCount; ++leg) {
    if (!sample.contact[leg]) continue;
    const LegMotion motion{joints_of(position, leg), joints_of(rate, leg), angular_velocity};
    const Eigen::Vector3d velocity = velocity_from_foot(leg, motion, geometry);
    sum += velocity;
    squares += velocity.cwiseAbs2();
    ++feet.count;
  }
  const double n = feet.count;
  if (n < 2) return feet;
  const Eigen::Array3d variance = (squares - sum.cwiseAbs2() / n) / (n - 1.0);
  feet.spread = variance.max(0.0).sqrt();
  return feet;
}

Eigen::Matrix3d sample_covariance(const LegNoiseConfig& config, const StanceFeet& feet,
                                  const LegConditions& conditions) {
  Eigen::Array3d variance = config.velocity_sigma.cwiseAbs2();
  if (feet.measured) {
    variance += (feet.spread.array().square() - squared(config.nominal_spread)).max(0.0);
    if (feet.count == 1) variance += squared(kOneFootSigma);
    if (feet.count == 0) variance += squared(kNoFootSigma);
  }
  variance += squared(kYawLever * conditions.yaw_rate);
  variance += squared(std::min(kGapGrowth * conditions.gap, kNoFootSigma));
  return variance.matrix().asDiagonal();
}

std::optional<double> gate_inflation(double distance) {
  const double factor = distance / kLegGate;
  if (!(factor <= kMaxVarianceGrowth)) return std::nullopt;
  return std::max(1.0, factor);
}

LegNoiseModel::LegNoiseModel(const LegNoiseConfig& config, const SensorRig& rig)
    : config_(config),
      geometry_(rig.leg_geometry),
      period_(1.0 / rig.leg_rate_hz),
      correlated_samples_(std::max(1.0, 2.0 * kLegCorrelationTime * rig.leg_rate_hz)) {}

Eigen::Matrix3d LegNoiseModel::noise(const LegOdometrySample& sample,
                                     const Eigen::Vector3d& angular_velocity) {
  LegConditions conditions;
  conditions.yaw_rate = angular_velocity.z();
  if (last_) {
    conditions.gap = std::max(0.0, to_seconds(sample.stamp - *last_) - 1.5 * period_);
  }
  last_ = sample.stamp;
  return correlated_samples_ *
         sample_covariance(config_, compare_stance_feet(sample, angular_velocity, geometry_),
                           conditions);
}

std::optional<double> LegNoiseModel::inflation(const LinearMeasurement& measurement,
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
  if (distance <= kLegGate || !last_) {
    outside_since_.reset();
    return 1.0;
  }
  if (!outside_since_) outside_since_ = last_;
  if (*last_ - *outside_since_ > kMaxSlipDuration) return 1.0;
  return gate_inflation(distance);
}

}  // namespace aims
