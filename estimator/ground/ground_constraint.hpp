// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "estimator/filter/kalman_update.hpp"
#include "estimator/ground/ground_plane.hpp"

namespace aims {

/// Result of the level test of one scan.
enum class GroundStatus {
  kNotFound,  ///< no ground plane in the scan
  kNotLevel,  ///< tilted, bent, or at another height: a ramp or a step
  kSettling,  ///< level, but for less than `settling_distance`
  kLevel,     ///< level, at the current height
};

/// Level ground as a measurement of roll, pitch and height. Ground that fails the level test is not
/// used until `settling_distance` of level ground has followed. Its height is then the reference:
/// that of an earlier level within `max_step`, otherwise a new one, so that a real climb is kept.
/// The unevenness is correlated along the path, so information is counted per
/// `correlation_length` travelled, not per scan.
class GroundConstraint {
 public:
  explicit GroundConstraint(const GroundConstraintConfig& config) : config_(config) {}

  /// Tests the ground plane of a scan at the predicted belief. Returns two rows that make the
  /// normal vertical and one for the height; empty when there is nothing to fuse. The noise
  /// includes the uncertainty of the reference height.
  std::optional<LinearMeasurement> measure(const Belief& predicted,
                                           const std::optional<GroundPlane>& plane);

  GroundStatus status() const { return status_; }

  /// Number of heights of level ground found so far.
  int levels() const { return static_cast<int>(levels_.size()); }

 private:
  /// A height of level ground.
  struct Level {
    double z = 0.0;         ///< odometry frame [m]
    double variance = 0.0;  ///< of the body height when it was added [m^2]
  };

  GroundStatus test_level(const Belief& predicted, const GroundPlane& plane, double z) const;
  bool settled(const Belief& predicted, double z, bool first);
  void select_level(const Belief& predicted, double z);
  LinearMeasurement rows(const Belief& predicted, const GroundPlane& plane, double z,
                         double correlated_samples) const;

  GroundConstraintConfig config_;
  GroundStatus status_ = GroundStatus::kNotFound;
  std::vector<Level> levels_;
  std::size_t current_ = 0;  ///< in `levels_`
  bool in_use_ = false;
  bool was_level_ = false;            ///< in the last scan with a ground plane
  double level_distance_ = 0.0;       ///< travelled since the ground became level [m]
  double distance_since_used_ = 0.0;  ///< travelled since the last measurement [m]
  std::optional<Eigen::Vector3d> last_position_;
};

/// The belief after fusing a ground measurement: a Schmidt-Kalman update that corrects rotation,
/// height, vertical velocity and inertial biases only. In a corridor the unobservable direction is
/// never exactly horizontal in the covariance, and millimetres of height would otherwise move the
/// position along it by decimetres.
Belief fuse_ground(const Belief& predicted, const LinearMeasurement& measurement);

}  // namespace aims
