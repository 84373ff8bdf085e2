// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/baselines/features/scan_estimator.hpp"
#include "estimator/baselines/loam/config.hpp"
#include "estimator/baselines/loam/scan_to_map.hpp"
#include "estimator/baselines/loam/scan_to_scan.hpp"

namespace aims::loam {

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
