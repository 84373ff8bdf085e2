// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/joint_compliance.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Times over which load and vertical velocity are averaged [s]: several strides.
constexpr double kLoadTime = 2.0;
constexpr double kClimbTime = 1.0;

/// Error of the mean vertical velocity by rigid feet over kClimbTime: lengths of links, rolling,
/// rubber that yields [m/s].
constexpr double kClimbSigma = 0.08;

/// Softer joints do not carry a robot [rad/m].
constexpr double kLargestCompliance = 3.0;
constexpr double kLeastVariance = 1e-4;

double gain_of(double time, double rate_hz) { return 1.0 - std::exp(-1.0 / (time * rate_hz)); }

}  // namespace

JointVector JointCompliance::yield(const LegOdometrySample& sample, const Eigen::Vector3d& up,
                                   const LegGeometry& geometry, double rate_hz) {
  JointVector yield = JointVector::Zero();
  if (!sample.contact_force) return yield;
  FootLoads loads = *sample.contact_force;
  double sum = 0.0;
  for (double& load : loads) {
    load = std::isfinite(load) ? std::max(load, 0.0) : 0.0;
    sum += load;
  }
  mean_load_ =
      mean_load_ == 0.0 ? sum : mean_load_ + gain_of(kLoadTime, rate_hz) * (sum - mean_load_);
  if (!(mean_load_ > 0.0)) return yield;
  const Eigen::Map<const JointVector> angle(sample.joint_position.data());
  for (int leg = 0; leg < kLegCount; ++leg) {
    const double share = loads[static_cast<std::size_t>(leg)] / mean_load_;
    yield.segment<3>(3 * leg) =
        share * foot_jacobian(leg, joints_of(angle, leg), geometry).transpose() * up;
  }
  return yield;
}

void JointCompliance::update(double climb, double change, double rate_hz) {
  const double gain = gain_of(kClimbTime, rate_hz);
  climb_ += gain * (climb - climb_);
  change_ += gain * (change - change_);
  const double noise = kClimbSigma * kClimbSigma * std::max(1.0, 2.0 * kClimbTime * rate_hz);
  const double posterior = variance_ / (1.0 + variance_ * change_ * change_ / noise);
  value_ = std::clamp(value_ - posterior * change_ * climb_ / noise, 0.0, kLargestCompliance);
  variance_ = std::max(posterior, kLeastVariance);
}

}  // namespace aims
