// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <vector>

#include "estimator/baselines/bievr/config.hpp"
#include "estimator/baselines/lio_sam/preintegration.hpp"
#include "estimator/filter/imu_propagation.hpp"

namespace aims::bievr {

using lio_sam::ImuBias;
using lio_sam::NavState;
using lio_sam::Preintegration;

inline constexpr double kGravity = 9.80665;  ///< of the published program [m/s^2]

/// What the IMU needs to predict: the biases, and where up is.
struct InertialState {
  ImuBias bias;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< unit, world axes
};

/// `segments` as one relative motion.
Preintegration preintegrated(const std::vector<InertialSegment>& segments, const ImuBias& bias);

/// The state after a motion.
NavState predicted(const NavState& from, const Preintegration& motion, const InertialState& x);

/// The IMU between two registered scans.
struct Interval {
  Time end = 0;  ///< of the second scan
  Pose from;     ///< T_world_body
  Pose to;
  Eigen::Vector3d velocity_to = Eigen::Vector3d::Zero();  ///< world axes [m/s]
  std::vector<InertialSegment> segments;
  Preintegration motion;  ///< of the segments
};

/// Least squares of velocities, biases and the direction of gravity over the intervals of the last
/// seconds, whose poses are fixed. Residuals of rotation [rad], position [m] and velocity [m/s]
/// have weight 1 each, as published; the velocity at the begin of the window is fixed.
class InertialWindow {
 public:
  explicit InertialWindow(const InertialConfig& config) : config_(config) {}

  /// Adds the interval that follows the last one; `velocity_from` counts for the first one alone.
  /// Intervals that begin before the window are left out.
  void add(Interval interval, const Eigen::Vector3d& velocity_from);

  /// Improves `x` and the velocities; false with too few intervals.
  bool solve(InertialState& x);

  /// At the end of the last interval [m/s].
  const Eigen::Vector3d& velocity() const { return intervals_.back().velocity_to; }
  void clear() { intervals_.clear(); }
  std::size_t size() const { return intervals_.size(); }

 private:
  double iterate(const Eigen::Vector3d& prior, InertialState& x);

  InertialConfig config_;
  std::deque<Interval> intervals_;
  Eigen::Vector3d first_velocity_ = Eigen::Vector3d::Zero();  ///< at the begin of the window
};

}  // namespace aims::bievr
