// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/joint_encoders.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Physics steps in a window, at least one.
std::size_t steps_in(double window, Duration timestep) {
  if (window <= 0.0) return 0;
  return static_cast<std::size_t>(std::max(1L, std::lround(window / to_seconds(timestep))));
}

}  // namespace

JointEncoders::JointEncoders(const LegOdometryConfig& config, Duration timestep,
                             const JointVector& offset, std::uint64_t run_seed)
    : config_(config),
      offset_(offset),
      window_(steps_in(config.joint_rate_window, timestep)),
      window_length_(static_cast<double>(window_) * to_seconds(timestep)),
      delay_(config.encoder_delay / to_seconds(timestep)),
      noise_(run_seed, "leg.encoder"),
      window_noise_(run_seed, "leg.encoder_window") {}

void JointEncoders::update(const JointMotion& motion) {
  motions_.push_back(motion);
  if (motions_.size() > window_ + static_cast<std::size_t>(std::ceil(delay_)) + 1) {
    motions_.pop_front();
  }
}

/// Motion so many physics steps ago, interpolated; the oldest known one beyond that.
JointMotion JointEncoders::motion_before(double steps) const {
  const double oldest = static_cast<double>(motions_.size() - 1);
  const double at = std::max(0.0, oldest - steps);
  const auto index = static_cast<std::size_t>(at);
  const double part = at - static_cast<double>(index);
  const JointMotion& from = motions_[index];
  if (part == 0.0) return from;
  const JointMotion& to = motions_[index + 1];
  return {from.angle + part * (to.angle - from.angle), from.rate + part * (to.rate - from.rate)};
}

/// The encoder counts whole steps.
double JointEncoders::reading(double angle, double noise) const {
  const double value = angle + noise;
  const double step = config_.joint_angle_resolution;
  return step > 0.0 ? step * std::round(value / step) : value;
}

void JointEncoders::read(LegOdometrySample& sample) {
  const JointMotion now = motion_before(delay_);
  const JointVector before = motion_before(delay_ + static_cast<double>(window_)).angle;
  const double sigma = config_.joint_angle_noise;
  for (int i = 0; i < kJointCount; ++i) {
    const double angle = reading(now.angle[i] + offset_[i], sigma * noise_.normal());
    const double rate_noise = config_.joint_rate_noise * noise_.normal();
    sample.joint_position[i] = angle;
    sample.joint_velocity[i] = now.rate[i] + rate_noise;
    if (window_ == 0) continue;
    const double earlier = reading(before[i] + offset_[i], sigma * window_noise_.normal());
    sample.joint_velocity[i] = (angle - earlier) / window_length_ + rate_noise;
  }
}

}  // namespace aims
