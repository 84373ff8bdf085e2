// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "core/time.hpp"
#include "estimator/constrained/scan_rule.hpp"
#include "estimator/filter/imu_noise.hpp"
#include "estimator/interface/diagnostics.hpp"

namespace aims {

/// A quantity that was not computed: an empty cell in the diagnostics file.
inline constexpr double kNotComputed = std::numeric_limits<double>::quiet_NaN();

/// A scan of which a smaller fraction of the points has planes is not where its map is.
inline constexpr double kMinMatched = 0.3;

/// Diagnostics of one LiDAR update; quantities of the paper have its symbols.
struct ScanDiagnostics {
  Time stamp = 0;                              ///< end of the scan
  int points_in = 0;                           ///< finite points in range
  int points_used = 0;                         ///< with an accepted plane in the final update
  int iterations = 0;                          ///< of the update; 0: refused, too few planes
  bool converged = false;                      ///< the last iteration made a small step
  double residual_mean = kNotComputed;         ///< after the trial update [m], eq. (3)
  double residual_sigma = kNotComputed;        ///< after the trial update [m], eq. (3)
  double residual_sigma_prior = kNotComputed;  ///< before the trial update [m]
  double O_lidar = kNotComputed;               ///< eq. (4), post-fit residuals
  double O_lidar_prior = kNotComputed;         ///< eq. (4), pre-fit residuals
  double C_IL = kNotComputed;                  ///< eq. (6), 6-D pose block, as D_k uses it
  double C_IL_imu = kNotComputed;              ///< against the IMU alone since the last scan
  double C_IL_imu_legs = kNotComputed;         ///< against the filter's prediction, legs included
  double C_IL_full = kNotComputed;             ///< eq. (6), the whole error state
  double D = kNotComputed;                     ///< D_k, eq. (7)
  double D_smoothed = kNotComputed;            ///< eq. (12)
  double gamma_lidar = 1.0;                    ///< eq. (8)
  double gamma_leg = 1.0;                      ///< eq. (10)
  Eigen::Vector3d innovation_rotation =
      Eigen::Vector3d::Constant(kNotComputed);  ///< y_k, eq. (5) [rad]
  Eigen::Vector3d innovation_position =
      Eigen::Vector3d::Constant(kNotComputed);  ///< y_k, eq. (5) [m]
  double smallest_eigenvalue = kNotComputed;    ///< of the translation information [1/m^2]
  double condition_number = kNotComputed;       ///< of the translation information
  double weak_weight = kNotComputed;            ///< real fraction of the information, weakest axis
  double weak_tilt = kNotComputed;              ///< of the planes towards the weakest axis [rad]
  double weak_information = kNotComputed;       ///< smallest of the position as real [1/m^2]
  double leg_innovation = kNotComputed;         ///< norm of the last leg innovation [m/s]
  int leg_updates = 0;                          ///< since the last scan
  ImuNoiseDensity imu_noise;                    ///< before the update, estimated
  double delay = kNotComputed;                  ///< of the IMU's stamps, after the update [s]
  Eigen::Vector3d mount =
      Eigen::Vector3d::Constant(kNotComputed);  ///< correction of the mount, rotation vector [rad]
  PoseCovariance covariance;                    ///< after the update
  bool relocated = false;                       ///< the scan was matched elsewhere than predicted
  ScanVerdict verdict;                          ///< of a ScanRule
};

/// The series that the filter reports: name, unit and meaning of each member above.
std::vector<SeriesInfo> scan_series();

/// A scan's values in the order of `scan_series`.
ScanRow row_of(const ScanDiagnostics& scan);

}  // namespace aims
