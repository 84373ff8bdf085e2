// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "estimator/baselines/features/feature_map.hpp"
#include "estimator/baselines/features/feature_solver.hpp"
#include "estimator/baselines/features/scan_estimator.hpp"
#include "estimator/baselines/loam/config.hpp"
#include "estimator/interface/diagnostics.hpp"

namespace aims::loam {

/// Motion of the LiDAR from the features of consecutive scans, at the rate of the scans.
class ScanToScan {
 public:
  explicit ScanToScan(const ScanToScanConfig& config) : config_(config) {}

  /// Registers the features of the next scan to those of the last one, then moves its less sharp
  /// and less flat features to the end of the scan. The search starts at the last motion.
  features::SolverResult update(features::RingFeatures& scan);

  /// T_odom_lidar at the end of the last scan; identity at that of the first.
  const Pose& pose() const { return T_odom_lidar_; }

 private:
  ScanToScanConfig config_;
  features::RingReference edges_;
  features::RingReference planes_;
  bool started_ = false;
  Pose motion_;  ///< T_laststart_end: from the end of the last scan to that of the present one
  Pose T_odom_lidar_;
};

/// Registration of the features of a scan to a map of edges and planes, which it extends.
class ScanToMap {
 public:
  explicit ScanToMap(const ScanToMapConfig& config);

  /// Registers and maps the less sharp and less flat features of a scan, LiDAR axes, whose odometry
  /// is `T_odom_lidar`.
  features::SolverResult update(const Pose& T_odom_lidar, const features::RingFeatures& scan);

  /// The pose in the map of an odometry pose, with the last correction of the odometry.
  Pose to_map(const Pose& T_odom_lidar) const { return T_map_odom_ * T_odom_lidar; }

  /// Points of the whole map [m].
  std::vector<Eigen::Vector3f> points() const;

 private:
  ScanToMapConfig config_;
  features::CubeMap edges_;
  features::CubeMap planes_;
  features::MapReference reference_;
  Pose T_map_odom_;
};

/// LOAM without IMU: edge and plane features, scan to scan odometry, registration to a map.
class Loam final : public features::ScanEstimator {
 public:
  Loam(const Config& config, const SensorRig& rig);

 private:
  void process(const LidarScan& scan) override;
  std::vector<Eigen::Vector3f> points_in_lidar_axes() const override { return mapping_.points(); }

  Config config_;
  ScanToScan odometry_;
  ScanToMap mapping_;
  int scans_ = 0;
};

}  // namespace aims::loam
