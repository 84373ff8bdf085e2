// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "estimator/aims/config.hpp"
#include "estimator/aims/scan_diagnostics.hpp"
#include "estimator/degeneracy/cross_validation.hpp"
#include "estimator/degeneracy/degeneracy.hpp"
#include "estimator/filter/kalman_update.hpp"
#include "estimator/lidar/scan_matcher.hpp"
#include "estimator/lidar/voxel_map.hpp"

namespace aims {

/// Planes needed for an update.
inline constexpr int kMinMatches = 30;

/// The LiDAR correction: an iterated trial update with the nominal noise, the degeneracy index from
/// its residuals and innovation, and the final update with the noise scaled by the index. With
/// `cross_validation` the information that comes from the noise of the map is removed.
class LidarUpdate {
 public:
  explicit LidarUpdate(const EskfConfig& config);

  /// The belief after fusing `points` (body axes at the time of the belief) with `map`. Fills the
  /// index, weights and statistics of `diagnostics`. With too few planes at any linearization, the
  /// last included, the belief and the index are unchanged and `iterations` is 0. `leg_free` is the
  /// prediction of the IMU alone, for C_IL; null: not known, C_IL then takes `predicted`.
  /// `calibration` is the scan's dependence on mount and delay.
  Belief update(const Belief& predicted, std::span<const Eigen::Vector3f> points,
                const VoxelMap& map, const CalibrationModel& calibration,
                ScanDiagnostics& diagnostics, const Belief* leg_free = nullptr);

  /// gamma_leg after the last scan, eq. (10); 1 before the first.
  double gamma_leg() const { return gamma_leg_; }

  /// Whether the leg states are consider states: while scans leave a direction free, nothing but
  /// the legs measures the velocity along it.
  bool considers_legs() const {
    return cross_validation_.enabled && fraction_.leaves_direction_free();
  }

  /// Whether the robot has just started along a direction that scans leave free: its position along
  /// it then follows legs whose scale nothing has measured yet.
  bool follows_unknown_legs() const {
    return cross_validation_.enabled && fraction_.leaves_start_free();
  }

  /// Gain mask of what measures the velocity. While scans leave a direction free, the position
  /// along it is the integral of the velocity, and both carry the error of the leg scale. That
  /// error is common to the whole route and cancels in the gain only as far as the models of scale
  /// and velocity agree to a percent; what is left, times metres of uncertainty, would move the
  /// position with every sample.
  GainMask odometry_mask() const;

  /// Covariance of the map at the robot, odometry axes [m^2]; see map_covariance_after_scan().
  const Eigen::Matrix3d& map_covariance() const { return map_covariance_; }

 private:
  Linearization fused(const MatchInformation& scan, double gamma, const NominalState& state) const;
  NominalState first_guess(const Belief& predicted, std::span<const Eigen::Vector3f> points,
                           const VoxelMap& map, ScanDiagnostics& diagnostics);
  IteratedUpdate trial(const Belief& predicted, std::span<const Eigen::Vector3f> points,
                       const VoxelMap& map, ScanDiagnostics& diagnostics);
  void assess(const Belief& predicted, const NominalState& trial_state,
              ScanDiagnostics& diagnostics);
  void assess_degeneracy(double residual_variance, ScanDiagnostics& diagnostics);
  double leg_free_consistency(const Belief& leg_free, const NominalState& linearization,
                              const MatchInformation& scan) const;
  void update_map_covariance(const VoxelMap& map, const Belief& predicted, const Belief& updated);

  int max_iterations_;            ///< of the trial update
  CalibrationModel calibration_;  ///< of the present scan
  DegeneracyConfig degeneracy_;
  CrossValidationConfig cross_validation_;
  RealFraction fraction_;
  bool map_covariance_enabled_;
  ScanMatcher matcher_;
  SeverityFilter severity_;
  double gamma_lidar_ = 1.0;
  double gamma_leg_ = 1.0;
  Eigen::Matrix3d map_covariance_ = Eigen::Matrix3d::Zero();
};

}  // namespace aims
