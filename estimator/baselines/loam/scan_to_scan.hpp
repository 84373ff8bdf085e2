// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/baselines/loam/config.hpp"

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

}  // namespace aims::loam
