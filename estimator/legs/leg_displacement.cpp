// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/leg_displacement.hpp"

namespace aims {
namespace {

/// Part of an interval's packets below which its displacement is a guess more than a measurement.
constexpr double kLeastCoverage = 0.5;

/// The motion over `duration` at a constant twist, axes at its begin.
Pose moved(const Eigen::Vector3d& linear, const Eigen::Vector3d& angular, Duration duration) {
  const double dt = to_seconds(duration);
  const Eigen::Vector3d angle = angular * dt;
  return {so3_exp(angle), so3_right_jacobian(-angle) * linear * dt};
}

}  // namespace

LegIntegrator::LegIntegrator(const LegConfig& config) : config_(config) {}

void LegIntegrator::begin(Time stamp) {
  begin_ = stamp;
  integrated_until_ = stamp;
  packets_ = 0;
  T_begin_base_ = Pose{};
}

void LegIntegrator::add(const LegOdometrySample& sample) {
  if (sample.stamp > integrated_until_) {
    const LegOdometrySample& before = last_ ? *last_ : sample;
    T_begin_base_ = T_begin_base_ * moved(0.5 * (before.linear_velocity + sample.linear_velocity),
                                          0.5 * (before.angular_velocity + sample.angular_velocity),
                                          sample.stamp - integrated_until_);
    integrated_until_ = sample.stamp;
    ++packets_;
  }
  last_ = sample;
}

std::optional<LegDisplacement> LegIntegrator::until(Time stamp) const {
  const Duration duration = stamp - begin_;
  const double expected = to_seconds(duration) * config_.rate_hz;
  if (packets_ == 0 || packets_ < kLeastCoverage * expected) return std::nullopt;
  const Pose rest =
      moved(last_->linear_velocity, last_->angular_velocity, stamp - integrated_until_);
  return LegDisplacement{(T_begin_base_ * rest).translation, duration, packets_};
}

}  // namespace aims
