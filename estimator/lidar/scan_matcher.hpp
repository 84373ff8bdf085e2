// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "estimator/degeneracy/cross_validation.hpp"
#include "estimator/lidar/lidar_config.hpp"
#include "estimator/lidar/map_covariance.hpp"
#include "estimator/lidar/plane_model.hpp"
#include "estimator/lidar/residual_noise.hpp"
#include "estimator/lidar/voxel_map.hpp"

namespace aims {

/// Larger residuals are rejected [m].
inline constexpr double kMaxResidual = 0.2;

/// The rows of all accepted matches at one pose, nominal noise.
struct MatchInformation {
  HalvesInformation halves;
  int used = 0;  ///< accepted matches
};

/// How many matches agree with a pose.
struct Agreement {
  int all = 0;
  int facing = 0;  ///< those whose planes face along the axis that is in question
};

/// An accepted match: a point and what its planes have in common.
struct Correspondence {
  Eigen::Vector3d point;           ///< body axes [m]
  Eigen::Vector3d normal;          ///< mean of both planes' normals, odometry axes
  Eigen::Vector3d normal_in_body;  ///< the same
  double residual;                 ///< mean of both planes' [m]
};

/// Matches the points of a scan with the planes of the map and linearizes eq. (2).
class ScanMatcher {
 public:
  /// `correlated_points`: LidarUpdateConfig::correlated_points.
  ScanMatcher(double correlated_points, const RobustKernelConfig& kernel);

  /// Starts a scan that was taken from `sensor` (body axes) [m]: no robust weights until
  /// start_robust_weights().
  void reset(const Eigen::Vector3d& sensor);

  /// Searches the planes of one in `stride` of `points` (body axes) at `T_odom_body`.
  void match(const Pose& T_odom_body, std::span<const Eigen::Vector3f> points, const VoxelMap& map,
             std::size_t stride = 1);

  /// The points without a plane within kMaxResidual where match() searched, body axes.
  std::span<const Eigen::Vector3d> unmatched() const { return unmatched_; }

  /// Of the matches, those whose residual at `T_odom_body` is that of noise.
  Agreement agreement(const Pose& T_odom_body, const Eigen::Vector3d& axis) const;

  /// Sums the rows of the matches within the residual gate at `T_odom_body`.
  MatchInformation linearize(const Pose& T_odom_body);

  /// The matches within the residual gate at `T_odom_body`.
  std::vector<Correspondence> correspondences(const Pose& T_odom_body) const;

  /// From now on a Cauchy kernel weighs each residual by its own deviation.
  void start_robust_weights() { robust_ = kernel_.enabled; }

  /// Adds the residuals of the last linearization to the noise of the next scans.
  void learn_noise() { noise_.learn(incident_residuals_); }

  /// Residuals of the last linearization [m].
  const std::vector<double>& residuals() const { return residuals_; }

  /// The matched planes with the map covariance at the points, for the pose `T_odom_body`.
  std::span<const MappedPlane> mapped_planes(const Pose& T_odom_body, const VoxelMap& map);

 private:
  /// A point with its planes.
  struct Match {
    Eigen::Vector3d p_body;
    PlanePair planes;
    double cosine;  ///< of the incidence
    double sigma;   ///< deviation of its residual [m]
    double scale;   ///< of the robust kernel [m]
  };

  double correlated_points_;
  RobustKernelConfig kernel_;
  ResidualNoise noise_;
  Eigen::Vector3d sensor_ = Eigen::Vector3d::Zero();
  bool robust_ = false;
  std::vector<Match> matches_;
  std::vector<Eigen::Vector3d> unmatched_;  ///< body axes
  std::vector<double> residuals_;
  std::vector<IncidentResidual> incident_residuals_;
  std::vector<MappedPlane> mapped_planes_;
};

}  // namespace aims
