// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "estimator/baselines/features/scan_estimator.hpp"
#include "estimator/baselines/lego_loam/config.hpp"
#include "estimator/baselines/lego_loam/mapping.hpp"
#include "estimator/interface/diagnostics.hpp"

namespace aims::lego_loam {

/// What the two steps of the odometry found.
struct OdometryResult {
  features::SolverResult ground;  ///< roll, pitch and height from the planes of the ground
  features::SolverResult edges;   ///< then heading and horizontal position from edges
};

/// Motion of the LiDAR from the features of consecutive scans.
class TwoStepOdometry {
 public:
  explicit TwoStepOdometry(const OdometryConfig& config) : config_(config) {}

  /// Registers the features of the next scan to those of the last one, then moves its less sharp
  /// and less flat features to the end of the scan. The search starts at the last motion.
  OdometryResult update(features::RingFeatures& scan);

  /// T_odom_lidar at the end of the last scan; identity at that of the first.
  const Pose& pose() const { return T_odom_lidar_; }

 private:
  OdometryResult solve(const features::RingFeatures& scan) const;

  OdometryConfig config_;
  features::RingReference edges_;
  features::RingReference planes_;
  bool started_ = false;
  Pose motion_;  ///< from the end of the last scan to that of the present one
  Pose T_odom_lidar_;
};

/// LeGO-LOAM without IMU: ground and segments of a range image, odometry in two steps, registration
/// to keyframes (docs/baselines/lego_loam.md).
class LegoLoam final : public features::ScanEstimator {
 public:
  LegoLoam(const Config& config, const SensorRig& rig);

 private:
  void process(const LidarScan& scan) override;
  std::vector<Eigen::Vector3f> points_in_lidar_axes() const override {
    return mapping_.map().points();
  }

  Config config_;
  TwoStepOdometry odometry_;
  Mapping mapping_;
  bool started_ = false;
};

}  // namespace aims::lego_loam
