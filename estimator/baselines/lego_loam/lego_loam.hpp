// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/baselines/lego_loam/config.hpp"
#include "estimator/baselines/lego_loam/mapping.hpp"
#include "estimator/baselines/lego_loam/two_step_odometry.hpp"
#include "estimator/estimator.hpp"

namespace aims::lego_loam {

/// LeGO-LOAM without IMU and without loop closure: ground and segments of a range image, odometry
/// in two steps, registration to keyframes. The odometry frame is that of the body at the end of
/// the first scan.
class LegoLoam : public Estimator {
 public:
  LegoLoam(const Config& config, const SensorRig& rig);

  void consume(const Delivery& delivery) override;
  void finish() override;
  const EstimatorResult& result() const override { return result_; }
  std::vector<Eigen::Vector3f> map_points() const override;

 private:
  void process_ready();
  void process(const LidarScan& scan);

  Config config_;
  SensorRig rig_;
  MeasurementQueue queue_;
  TwoStepOdometry odometry_;
  Mapping mapping_;
  bool started_ = false;
  EstimatorResult result_;
};

}  // namespace aims::lego_loam
