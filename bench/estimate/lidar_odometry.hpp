// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/lie.hpp"
#include "core/measurements.hpp"
#include "core/trajectory.hpp"
#include "estimator/lidar/voxel_map.hpp"

namespace aims {

/// Odometry by a LiDAR of any kind alone: no IMU, no rings. Distances of the returns from planes of
/// a local map give the pose in the middle of a scan and its velocity, which deskews it (elastic
/// registration, as in CT-ICP, Dellenbach et al. 2022); along what planes leave free it moves as
/// before.
class LidarOdometry {
 public:
  LidarOdometry();

  /// A scan that finds too few planes ends the path: what follows is a path of its own.
  void add(const LidarScan& scan);

  /// T_start_lidar at the middle of each scan, a trajectory for each path.
  const std::vector<Trajectory>& paths() const { return paths_; }

 private:
  /// A return and its firing after the middle of the scan: x, y, z [m], t [s].
  using TimedPoint = Eigen::Vector4f;

  /// Constant over a scan, LiDAR axes.
  struct Twist {
    Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< [rad/s]
    Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< [m/s]

    /// The point in LiDAR axes at the middle of its scan.
    Eigen::Vector3d deskewed(const TimedPoint& point) const;
  };

  struct Motion {
    Pose pose;  ///< T_start_lidar at the middle of the scan
    Twist twist;
  };
  struct NormalEquations;

  void begin_path();
  bool register_points(std::span<const TimedPoint> points, Motion& motion) const;
  void insert(std::span<const TimedPoint> points, const Motion& motion);

  VoxelMap map_;
  std::vector<Trajectory> paths_;
  Twist twist_;  ///< of the last scan
};

}  // namespace aims
