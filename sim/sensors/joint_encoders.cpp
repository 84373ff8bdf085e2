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
      noise_(run_seed, "leg.encoder"),
      window_noise_(run_seed, "leg.encoder_window") {}

void JointEncoders::update(const JointMotion& motion) {
  rate_ = motion.rate;
  angles_.push_back(motion.angle);
  if (angles_.size() > window_ + 1) angles_.pop_front();
}

/// The encoder counts whole steps.
double JointEncoders::reading(double angle, double noise) const {
  const double value = angle + noise;
  const double step = config_.joint_angle_resolution;
  return step > 0.0 ? step * std::round(value / step) : value;
}

void JointEncoders::read(LegOdometrySample& sample) {
  const JointVector& now = angles_.back();
  const JointVector& before = angles_.front();
  const double sigma = config_.joint_angle_noise;
  for (int i = 0; i < kJointCount; ++i) {
    const double angle = reading(now[i] + offset_[i], sigma * noise_.normal());
    const double rate_noise = config_.joint_rate_noise * noise_.normal();
    sample.joint_position[i] = angle;
    sample.joint_velocity[i] = rate_[i] + rate_noise;
    if (window_ == 0) continue;
    const double earlier = reading(before[i] + offset_[i], sigma * window_noise_.normal());
    sample.joint_velocity[i] = (angle - earlier) / window_length_ + rate_noise;
  }
}

}  // namespace aims
