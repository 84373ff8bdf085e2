// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <deque>
#include <vector>

#include "core/measurements.hpp"
#include "core/trajectory.hpp"
#include "estimator/lidar/voxel_hash.hpp"
#include "sim/environment/scene.hpp"

namespace aims {

/// A point of a map, and the time of its first return.
struct GrownPoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< [m]
  Time seen = 0;
};

/// A scan at its place: some of its returns.
struct PlacedScan {
  Time end = 0;
  std::vector<Eigen::Vector3f> points;  ///< [m]
};

/// How scans become the map that a film shows.
struct MapGrowthConfig {
  float spacing = 0.04F;    ///< edge of a voxel [m]
  float reach = 15.0F;      ///< longest range of a return that is kept [m]
  int every_scan = 2;       ///< every n-th scan is inserted
  int scan_returns = 2000;  ///< most returns of a placed scan
};

/// The map of a trajectory: each return of a scan is placed by the pose at its own firing time, and
/// each voxel keeps its first return. Unlike an estimator's own map it holds the time of each
/// point, and depends on the trajectory alone.
class MapGrowth {
 public:
  explicit MapGrowth(const Pose& T_body_lidar, const MapGrowthConfig& config = {});

  /// Queues a scan until the trajectory covers it. `moving`: its returns that are no part of the
  /// map; empty: none.
  void add(const LidarScanPtr& scan, std::vector<bool> moving = {});
  /// Inserts the scans that `trajectory` (T_odom_body) covers by now.
  void settle(const Trajectory& trajectory);

  /// In the odometry frame, in order of time.
  const std::vector<GrownPoint>& points() const { return points_; }
  /// The inserted scans in the odometry frame, in order of time.
  const std::vector<PlacedScan>& scans() const { return placed_; }

 private:
  struct Waiting {
    LidarScanPtr scan;
    std::vector<bool> moving;
  };
  void insert(const Waiting& each, const Trajectory& trajectory);

  Pose T_body_lidar_;
  MapGrowthConfig config_;
  int scans_ = 0;
  std::deque<Waiting> waiting_;
  VoxelHash cubes_;
  std::vector<GrownPoint> points_;
  std::vector<PlacedScan> placed_;
};

/// For each return of a scan whether it came from a person, by the true poses of robot
/// (`truth`, T_world_body) and people at its firing time. Empty in a scene without people. For
/// pictures: no estimator has this.
std::vector<bool> moving_returns(const LidarScan& scan, const Scene& scene, const Trajectory& truth,
                                 const Pose& T_body_lidar);

}  // namespace aims
