// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "estimator/filter/error_state.hpp"
#include "estimator/filter/kalman_update.hpp"
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

/// What the floor below the robot is, for one scan.
enum class GroundStatus {
  kNotFound,  ///< no ground plane in the scan
  kSloped,    ///< more likely a ramp than level
  kLevel,     ///< more likely level
};

/// Level ground as a measurement of roll, pitch and height. The floor is piecewise level: a floor
/// at the height it had (also of an earlier level), a level floor at another height, or a slope.
/// Each is a hypothesis with a prior and a likelihood of the tracked floor plane under the filter's
/// own covariance (docs/estimators.md); no limit applies to the attitude.
class GroundConstraint {
 public:
  explicit GroundConstraint(const GroundConstraintConfig& config)
      : config_(config), tracker_(config) {}

  /// Weighs the hypotheses for the ground plane of a scan at `belief`. Returns two rows that make
  /// the normal vertical and one for the height; empty when there is nothing to fuse.
  std::optional<LinearMeasurement> measure(const Belief& belief,
                                           const std::optional<GroundPlane>& plane);

  /// Keeps the tracked floor in the corrected frame; call it after a measurement was fused.
  /// `start`: also the path since the start was corrected, so that the floor has another height.
  void corrected(const NominalState& state, bool start = false);

  GroundStatus status() const { return status_; }

  /// Whether the last ground plane showed that the start, which passed for level, was a slope: the
  /// frame and all that was mapped in it are tilted. The measurement levels them.
  bool start_was_sloped() const { return start_was_sloped_; }

  /// Probability that the ground of the last scan is level [-].
  double level_probability() const { return level_probability_; }

  /// Number of heights of level ground found so far.
  int levels() const { return static_cast<int>(levels_.size()); }

 private:
  /// A height of level ground.
  struct Level {
    double z = 0.0;         ///< odometry frame [m]
    double variance = 0.0;  ///< of the body height when it was added [m^2]
  };

  /// The levels that were found, as hypotheses of one scan.
  struct KnownLevels {
    double weight = 0.0;                   ///< of all
    std::optional<std::size_t> likeliest;  ///< in `levels_`
  };

  /// The first level, in case it was a slope.
  struct Start {
    Eigen::Vector3d position;    ///< of the body, odometry frame [m]
    double odds;                 ///< of a slope against level ground [-]
    Eigen::Vector2d slope;       ///< of its ground, in axes that the constraint has not levelled
    Eigen::Matrix2d covariance;  ///< of this slope [rad^2]
  };

  void weigh(const Belief& belief);
  KnownLevels known_levels(const Eigen::Matrix3d& covariance) const;
  double sloped_start_weight(const Belief& belief, const Eigen::Matrix3d& covariance) const;
  double level_density(std::size_t index, const Eigen::Matrix3d& covariance) const;
  Start start_of(const Belief& belief, double odds, const Eigen::Matrix2d& tilt) const;
  void start_again(const Belief& belief);
  void add_level(const Belief& belief);
  LinearMeasurement rows(const Belief& belief, const Eigen::Vector3d& floor) const;

  GroundConstraintConfig config_;
  FloorTracker tracker_;
  GroundStatus status_ = GroundStatus::kNotFound;
  double level_probability_ = 0.0;
  std::vector<Level> levels_;
  std::optional<std::size_t> current_;  ///< in `levels_`; empty on a slope
  double last_height_ = 0.0;            ///< of the tracked floor when it was last level [m]
  double distance_since_used_ = 0.0;    ///< travelled since the last measurement [m]
  std::optional<GroundPlane> plane_;    ///< of the last scan
  std::optional<Start> start_;
  bool start_was_sloped_ = false;
};

/// The belief about height and tilt above the ground. A scan locates the body in the map, which has
/// an error of its own: in height as `map_covariance` (3x3, odometry frame [m^2]) states, in tilt
/// as this height error over the radius of the ground. Without it the constraint loses against
/// scans that agree with a bent map.
Belief with_map_error(const Belief& belief, const Eigen::Matrix3d& map_covariance);

/// The belief, at least as uncertain of attitude and accelerometer bias as `start`: scans that are
/// matched in a map from there measure neither.
Belief with_tilt_of(const Belief& belief, const Belief& start);

/// The belief with the path since `start` turned as its attitude was since `before`.
Belief with_turned_path(Belief belief, const NominalState& before, const NominalState& start);

/// The belief after fusing a ground measurement: a Schmidt-Kalman update that corrects rotation,
/// height, vertical velocity and inertial biases only. In a corridor the unobservable direction is
/// never exactly horizontal in the covariance, and millimetres of height would otherwise move the
/// position along it by decimetres.
Belief fuse_ground(const Belief& belief, const LinearMeasurement& measurement);

}  // namespace aims
