// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "core/measurements.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// Diagnostics of one LiDAR update; quantities of the paper have its symbols.
struct ScanDiagnostics {
  Time stamp = 0;       ///< end of the scan
  int points_in = 0;    ///< finite points in range
  int points_used = 0;  ///< with an accepted plane in the final update
  int iterations = 0;      ///< of the update; 0: refused, too few planes
  bool converged = false;  ///< the last iteration made a small step
  double residual_mean = 0.0;         ///< after the trial update [m], eq. (3)
  double residual_sigma = 0.0;        ///< after the trial update [m], eq. (3)
  double residual_sigma_prior = 0.0;  ///< before the trial update [m]
  double O_lidar = 0.0;               ///< eq. (4), post-fit residuals
  double O_lidar_prior = 0.0;         ///< eq. (4), pre-fit residuals
  double C_IL = 0.0;                  ///< eq. (6), 6-D pose block
  double C_IL_full = 0.0;             ///< eq. (6), 15-D
  double D = 0.0;                     ///< D_k, eq. (7)
  double D_smoothed = 0.0;            ///< eq. (12)
  double gamma_lidar = 1.0;           ///< eq. (8)
  double gamma_leg = 1.0;             ///< eq. (10)
  Eigen::Vector3d innovation_rotation = Eigen::Vector3d::Zero();  ///< y_k, eq. (5) [rad]
  Eigen::Vector3d innovation_position = Eigen::Vector3d::Zero();  ///< y_k, eq. (5) [m]
  double smallest_eigenvalue = 0.0;  ///< of the translation information [1/m^2]
  double condition_number = 0.0;     ///< of the translation information
  double weak_weight = 1.0;          ///< significant fraction of the information, weakest axis
  double weak_ratio = 0.0;           ///< smallest ratio of information to noise-induced information
  double leg_innovation = 0.0;       ///< norm of the last leg innovation [m/s]
  int leg_updates = 0;               ///< since the last scan
  Eigen::Matrix3d position_covariance =
      Eigen::Matrix3d::Zero();  ///< after the update, body axes [m^2]
  Eigen::Matrix3d rotation_covariance =
      Eigen::Matrix3d::Zero();  ///< after the update, body axes [rad^2]
};

/// Longest time between reported poses while scans are missing.
inline constexpr Duration kMaxPoseInterval = 250 * kMillisecond;

/// Estimate so far.
struct EstimatorResult {
  /// T_odom_body at each scan end, or after `kMaxPoseInterval`; starts at identity
  Trajectory trajectory;
  std::vector<ScanDiagnostics> diagnostics;  ///< one per scan (empty for `leg`)
  std::map<std::string, int> counts;         ///< e.g. late, duplicate, non-finite measurements
};

/// Turns a stream of deliveries into a trajectory. Never throws on data, never reads a clock.
class Estimator {
 public:
  virtual ~Estimator() = default;

  /// Processes one measurement; call in order of arrival.
  virtual void consume(const Delivery& delivery) = 0;

  /// Processes the measurements still held for reordering; call once, after the last delivery.
  virtual void finish() = 0;

  virtual const EstimatorResult& result() const = 0;

  /// Points of the local map in the odometry frame [m]; empty for an estimator without a map.
  virtual std::vector<Eigen::Vector3f> map_points() const = 0;
};

}  // namespace aims
