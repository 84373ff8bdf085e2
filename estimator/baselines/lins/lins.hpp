// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "estimator/baselines/features/scan_estimator.hpp"
#include "estimator/baselines/lego_loam/mapping.hpp"
#include "estimator/baselines/lins/robocentric_odometry.hpp"
#include "estimator/interface/diagnostics.hpp"

namespace aims::lins {

/// LINS: LeGO-LOAM's features, a filter on the motion from scan to scan with the IMU, and
/// LeGO-LOAM's mapping (docs/baselines/lins.md). The map is level at the first LiDAR.
class Lins final : public features::ScanEstimator {
 public:
  Lins(const Config& config, const SensorRig& rig);

 private:
  void process(const LidarScan& scan) override;
  std::vector<Eigen::Vector3f> points_in_lidar_axes() const override {
    return mapping_.map().points();
  }
  std::vector<ImuSample> samples_until(Time end) const;

  Config config_;
  Eigen::Matrix3d R_lidar_body_;
  RobocentricOdometry odometry_;
  lego_loam::Mapping mapping_;
};

}  // namespace aims::lins
