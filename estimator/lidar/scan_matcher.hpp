// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

#include "estimator/lidar/lidar_config.hpp"
#include "estimator/lidar/map_covariance.hpp"
#include "estimator/lidar/plane_model.hpp"
#include "estimator/lidar/voxel_map.hpp"

namespace aims {

/// The rows of all accepted matches at one pose, nominal noise.
struct MatchInformation {
  Matrix6 matrix = Matrix6::Zero();  ///< A = H^T R^-1 H
  Vector6 vector = Vector6::Zero();  ///< b = H^T R^-1 r
  Matrix6 noise = Matrix6::Zero();   ///< expected part of A from the noise of the normals
  int used = 0;                      ///< accepted matches
};

/// Matches the points of a scan with the planes of the map and linearizes eq. (2).
class ScanMatcher {
 public:
  /// `normal_noise`: also sum the noise-induced information of the normals.
  ScanMatcher(const LidarUpdateConfig& config, const RobustKernelConfig& kernel, bool normal_noise);

  /// Starts a scan: no robust weights until update_robust_scale().
  void reset() { robust_scale_ = kNotRobust; }

  /// Searches the planes of `points` (body axes) at `state`.
  void match(const NominalState& state, std::span<const Eigen::Vector3f> points,
             const VoxelMap& map);

  /// Sums the rows of the matches within the residual gate at `state`.
  MatchInformation linearize(const NominalState& state);

  /// Sets the scale of the Cauchy kernel from the residuals of the last linearization: their robust
  /// deviation times `RobustKernelConfig::scale`.
  void update_robust_scale();

  /// Adds the residuals of the last linearization to the noise of the next scans.
  void learn_noise();

  /// Deviation of a residual, averaged over scans [m].
  double residual_sigma() const { return sigma_; }

  /// Residuals of the last linearization [m].
  const std::vector<double>& residuals() const { return residuals_; }

  /// The matched planes with the map covariance at the points, for the pose in `state`.
  std::span<const MappedPlane> mapped_planes(const NominalState& state, const VoxelMap& map);

 private:
  static constexpr double kNotRobust = std::numeric_limits<double>::infinity();

  double deviation();

  /// A point with its plane.
  struct Match {
    Eigen::Vector3d p_body;
    Plane plane;
  };

  LidarUpdateConfig config_;
  RobustKernelConfig kernel_;
  bool normal_noise_;
  double sigma_;
  double robust_scale_ = kNotRobust;  ///< residual with weight one half [m]
  std::vector<Match> matches_;
  std::vector<double> residuals_;
  std::vector<double> magnitudes_;
  std::vector<MappedPlane> mapped_planes_;
};

}  // namespace aims
