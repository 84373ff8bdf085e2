// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "estimator/aims/directional_config.hpp"
#include "estimator/filter/kalman_update.hpp"
#include "estimator/ground/floor_plane.hpp"

namespace aims {

/// What the floor under a scan is taken for.
enum class FloorVerdict {
  kUnseen,    ///< no plane that could be a floor
  kNotLevel,  ///< tilted, bent, or at another height: a ramp, a step, the way to one
  kWaiting,   ///< level, but not yet for long enough to be believed again
  kLevel,     ///< level, and at the height that it had
};

/// A level floor as a measurement of roll, pitch and height. It is level until a scan says
/// otherwise, and again after `settle` metres of level floor, whose height is then the reference:
/// one that the walk has had before when it is that within its uncertainty, else a new one, so that
/// a real climb is kept.
/// The floor's unevenness is the same from one scan to the next; measurements are spread over the
/// way walked, as if each `correlation_length` told something new.
class FloorConstraint {
 public:
  explicit FloorConstraint(const FloorConfig& config) : config_(config) {}

  /// Judges the floor `seen` in a scan at the predicted belief. Empty when there is nothing to
  /// fuse; else two rows that hold the floor's normal vertical and one that holds its height, with
  /// the reference's own uncertainty.
  std::optional<LinearMeasurement> measure(const Belief& predicted,
                                           const std::optional<FloorPlane>& seen);

  FloorVerdict verdict() const { return verdict_; }

  /// Heights that level floor has had so far, odometry frame [m].
  int levels() const { return static_cast<int>(levels_.size()); }

 private:
  /// A height of level floor.
  struct Level {
    double z = 0.0;         ///< odometry frame [m]
    double variance = 0.0;  ///< of the pose's height when it was taken [m^2]
  };

  FloorVerdict judge(const Belief& predicted, const FloorPlane& floor, double z);
  void take_level(const Belief& predicted, double z);
  LinearMeasurement rows(const Belief& predicted, const FloorPlane& floor, double z,
                         double repeats) const;

  FloorConfig config_;
  FloorVerdict verdict_ = FloorVerdict::kUnseen;
  std::vector<Level> levels_;
  std::size_t current_ = 0;  ///< in `levels_`
  bool trusted_ = false;
  bool was_level_ = false;       ///< in the last scan that showed a floor
  double level_way_ = 0.0;       ///< walked since the floor is level again [m]
  double way_since_used_ = 0.0;  ///< walked since the last measurement [m]
  std::optional<Eigen::Vector3d> last_position_;
};

/// The belief after fusing a floor. Only rotation, height, vertical velocity and inertial biases
/// are corrected (Schmidt-Kalman update). What a corridor leaves open is never quite level in the
/// covariance, so that millimetres of height would move the pose along it by decimetres.
Belief fuse_floor(const Belief& predicted, const LinearMeasurement& measurement);

/// Joins the errors of tilt and accelerometer bias of a start that levelled itself by the mean
/// specific force: one is the other over gravity, so that whatever corrects the tilt finds the
/// bias. `covariance` blocks of rotation and vertical bias are kept.
Belief join_tilt_and_bias(Belief belief, double gravity);

}  // namespace aims
