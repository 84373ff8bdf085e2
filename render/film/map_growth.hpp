// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <deque>
#include <vector>

#include "core/measurements.hpp"
#include "core/trajectory.hpp"
#include "estimator/lidar/voxel_hash.hpp"

namespace aims {

/// A point of a map, and when the first return from there came.
struct GrownPoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< [m]
  Time seen = 0;
};

/// How scans become the map that a film shows.
struct MapGrowthConfig {
  float spacing = 0.04F;  ///< edge of the cubes that hold one point each [m]
  float reach = 15.0F;    ///< longest range of a return that is kept [m]
  int every_scan = 2;     ///< every n-th scan is laid down
};

/// The map that a trajectory makes: scans are laid down along it, each return by the pose at its
/// own firing time, and of each small cube the first return stays. Unlike an estimator's own map it
/// tells when each point came, and it holds nothing but what the trajectory says.
class MapGrowth {
 public:
  explicit MapGrowth(const Pose& T_body_lidar, const MapGrowthConfig& config = {});

  /// Takes a scan, which waits until the trajectory covers it.
  void add(const LidarScanPtr& scan);
  /// Lays down the scans that `trajectory` (T_odom_body) covers by now.
  void settle(const Trajectory& trajectory);

  /// In the odometry frame, in the order in which they came.
  const std::vector<GrownPoint>& points() const { return points_; }

 private:
  void lay_down(const LidarScan& scan, const Trajectory& trajectory);

  Pose T_body_lidar_;
  MapGrowthConfig config_;
  int scans_ = 0;
  std::deque<LidarScanPtr> waiting_;
  VoxelHash cubes_;
  std::vector<GrownPoint> points_;
};

}  // namespace aims
