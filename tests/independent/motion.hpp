// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/lie.hpp"

namespace aims::independent {

inline constexpr double kGravity = 9.81;     ///< [m/s^2]
inline constexpr double kStrideHz = 1.6;     ///< of the trot; two footfalls a stride [Hz]
inline constexpr double kBodyHeight = 0.35;  ///< of the IMU above the floor [m]

/// A move from 0 to `length` with speed limit and smooth ramps; its third derivative is continuous.
class SmoothMove {
 public:
  /// `length` >= `speed` * `ramp`: the limit is reached.
  SmoothMove(double length, double speed, double ramp);

  double duration() const { return cruise_ + 2.0 * ramp_; }  ///< [s]
  double position(double t) const;                           ///< t after the start [s]
  double rate(double t) const;                               ///< derivative of `position`

 private:
  double speed_;
  double ramp_;    ///< from 0 to `speed_` [s]
  double cruise_;  ///< at `speed_` [s]
};

struct WalkOptions {
  double length = 78.6;      ///< one way [m]
  double speed = 0.7;        ///< [m/s]
  double turn_rate = 0.6;    ///< at the far end [rad/s]
  double stand_start = 3.0;  ///< [s]
  double stand_end = 2.0;    ///< [s]
  std::uint64_t seed = 1;    ///< of the phases of gait and wander
};

/// What an ideal IMU measures and how the body moves, at an instant.
struct BodyState {
  Pose T_world_body;
  Eigen::Vector3d velocity;          ///< of the body, in world [m/s]
  Eigen::Vector3d angular_velocity;  ///< in body axes [rad/s]
  Eigen::Vector3d specific_force;    ///< in body axes [m/s^2]
};

/// A dog that stands, trots along +x, turns about, trots back and stands, as a smooth function of
/// time. The body is the IMU: x forward, y left, z up.
class Walk {
 public:
  explicit Walk(const WalkOptions& options);

  double duration() const { return end_ + options_.stand_end; }  ///< [s]
  double start() const { return options_.stand_start; }          ///< walking begins [s]
  double far_end() const { return turn_start_; }  ///< the far end is reached, before the turn [s]
  double end() const { return end_; }             ///< walking ends [s]

  Pose pose(double t) const;
  /// Derivatives are central differences of `pose`, exact to 1e-6 m/s^2 and 1e-8 rad/s.
  BodyState state(double t) const;
  /// 0 while standing, 1 at full speed or turn rate.
  double activity(double t) const;
  /// Strides since the walk began; a footfall at each multiple of 1/2.
  double strides(double t) const { return kStrideHz * (t - options_.stand_start); }

 private:
  WalkOptions options_;
  SmoothMove leg_;   ///< one way
  SmoothMove turn_;  ///< the heading in the turn
  double turn_start_;
  double back_start_;
  double end_;
  Eigen::Array4d phases_;  ///< of the wander and of the gait's oscillations [rad]
};

}  // namespace aims::independent
