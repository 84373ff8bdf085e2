// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <functional>
#include <numbers>

#include "bench/metrics/association.hpp"
#include "core/trajectory.hpp"

namespace aims::test {

/// Poses from `begin` to `end` [s] inclusive, every `step` [s], of a motion given over seconds.
inline Trajectory sampled(double begin, double end, double step,
                          const std::function<Pose(double)>& motion) {
  Trajectory trajectory;
  const auto count = static_cast<int>(std::llround((end - begin) / step));
  for (int i = 0; i <= count; ++i) {
    const double t = begin + i * step;
    trajectory.push_back({from_seconds(t), motion(t)});
  }
  return trajectory;
}

inline constexpr double kLength = 40.0;    ///< of the corridor [m]
inline constexpr double kSpeed = 1.0;      ///< [m/s]
inline constexpr double kTurnTime = 10.0;  ///< at the far end [s]
inline constexpr double kThere = kLength / kSpeed;
inline constexpr double kBackFrom = kThere + kTurnTime;
inline constexpr double kEnd = kBackFrom + kThere;

/// A walk along x to the corridor's far end, a turn in place by 180 degrees, and the way back.
inline Pose there_and_back(double t) {
  if (t < kThere) return {yaw_rotation(0.0), {kSpeed * t, 0.0, 0.3}};
  if (t < kBackFrom) {
    return {yaw_rotation(std::numbers::pi * (t - kThere) / kTurnTime), {kLength, 0.0, 0.3}};
  }
  return {yaw_rotation(std::numbers::pi), {kLength - kSpeed * (t - kBackFrom), 0.0, 0.3}};
}

inline Trajectory true_walk() { return sampled(0.0, kEnd, 0.01, there_and_back); }

inline std::vector<WaypointTime> walk_waypoint_times() {
  return {{"a", 0}, {"b", from_seconds(kThere)}, {"a", from_seconds(kEnd)}};
}

/// An estimate of the walk at 10 Hz: the true motion in another frame, changed by `change`.
inline Trajectory estimated_walk(const std::function<Pose(double, Pose)>& change) {
  const Pose T_odom_world = {yaw_rotation(0.7), {5.0, -3.0, 1.0}};
  return sampled(0.0, kEnd, 0.1,
                 [&](double t) { return T_odom_world * change(t, there_and_back(t)); });
}

inline Trajectory perfect_walk() {
  return estimated_walk([](double, const Pose& pose) { return pose; });
}

}  // namespace aims::test
