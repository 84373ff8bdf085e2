// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

#include "bench/metrics/posterior_bound.hpp"
#include "core/lie.hpp"

namespace aims::testing {

inline constexpr double kMotionStep = 0.02;  ///< [s]

/// A body that moves along x without turning: v = speed, accelerating by `acceleration`.
inline std::vector<TrueMotion> straight_motion(double seconds, double speed,
                                               double acceleration = 0.0) {
  std::vector<TrueMotion> motion;
  const int steps = static_cast<int>(std::lround(seconds / kMotionStep));
  for (int i = 0; i <= steps; ++i) {
    const double t = i * kMotionStep;
    TrueMotion at;
    at.stamp = from_seconds(t);
    at.T_world_body.translation.x() = speed * t + 0.5 * acceleration * t * t;
    at.velocity.x() = speed + acceleration * t;
    motion.push_back(at);
  }
  return motion;
}

/// A body that walks off from rest along a curve, turning, rolling and bobbing as it goes.
inline std::vector<TrueMotion> curved_motion(double seconds) {
  std::vector<TrueMotion> motion;
  const auto pose_of = [](double t) {
    const double arc = 0.1 * t * t;
    const Eigen::Vector3d rotation(0.1 * std::sin(3.0 * t), 0.08 * std::cos(4.0 * t), 0.5 * t);
    return Pose{
        so3_exp(rotation),
        {1.4 * std::sin(arc), 1.4 * (1.0 - std::cos(arc)), 0.03 * (1.0 - std::cos(5.0 * t))}};
  };
  for (int i = 0; i <= std::lround(seconds / kMotionStep); ++i) {
    const double t = i * kMotionStep;
    TrueMotion at;
    at.stamp = from_seconds(t);
    at.T_world_body = pose_of(t);
    at.velocity = (pose_of(t + 1e-5).translation - pose_of(t - 1e-5).translation) / 2e-5;
    at.angular_velocity =
        so3_log(pose_of(t - 1e-5).rotation.conjugate() * pose_of(t + 1e-5).rotation) / 2e-5;
    motion.push_back(at);
  }
  return motion;
}

/// Everything known but for what a test adds.
inline BoundParameters certain() {
  BoundParameters p;
  p.legs.used = false;
  p.legs.scale_sigma = 0.0;
  p.initial = {1e-9, 1e-9, 1e-9, 1e-9};
  return p;
}

}  // namespace aims::testing
