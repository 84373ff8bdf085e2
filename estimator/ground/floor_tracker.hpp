// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "estimator/filter/error_state.hpp"
#include "estimator/ground/ground_plane.hpp"

namespace aims {

/// The ground plane below the robot in odometry axes: x and y of its upward normal, and its height
/// below the body [rad, rad, m].
Eigen::Vector3d floor_of(const NominalState& state, const GroundPlane& plane);

/// The floor plane below the robot as a state with its own covariance, apart from the filter: slope
/// and height in odometry axes. It follows the position along its slope and changes at bends, whose
/// rate and size give the process noise. The noise of one scan is estimated online, from the
/// differences of consecutive scans.
class FloorTracker {
 public:
  explicit FloorTracker(const GroundConstraintConfig& config) : config_(config) {}

  /// Predicts to `state` and fuses the plane of one scan.
  void update(const NominalState& state, const GroundPlane& plane);

  /// Moves the tracked floor with a correction of the odometry frame by `shift`.
  void shift(const Eigen::Vector3d& shift);

  /// Slope and height of the floor, as floor_of().
  const Eigen::Vector3d& floor() const { return floor_; }

  const Eigen::Matrix3d& covariance() const { return covariance_; }

  /// The plane of the last scan, as floor_of().
  const Eigen::Vector3d& measured() const { return measured_; }

  /// Covariance of the last scan's plane, without the filter's and without unevenness.
  const Eigen::Matrix3d& noise() const { return noise_; }

  /// Distance between the last two scans [m].
  double moved() const { return moved_; }

 private:
  void estimate_noise(const Eigen::Vector3d& measured, const GroundPlane& plane,
                      const Eigen::Matrix3d& R);

  GroundConstraintConfig config_;
  bool started_ = false;
  double moved_ = 0.0;
  double differences_ = 0.0;  ///< number in the averages below, forgotten exponentially
  double slope_square_ = 0.0;
  double height_square_ = 0.0;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d floor_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d measured_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d noise_ = Eigen::Matrix3d::Zero();
};

}  // namespace aims
