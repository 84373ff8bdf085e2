// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/baselines/features/scan_estimator.hpp"
#include "estimator/baselines/lego_loam/config.hpp"
#include "estimator/baselines/lego_loam/mapping.hpp"
#include "estimator/baselines/lego_loam/two_step_odometry.hpp"

namespace aims::lego_loam {

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
