// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/baselines/loam/config.hpp"
#include "estimator/baselines/loam/scan_to_map.hpp"
#include "estimator/baselines/loam/scan_to_scan.hpp"
#include "estimator/estimator.hpp"

namespace aims::loam {

/// LOAM without IMU: edge and plane features, scan to scan odometry, registration to a map. The
/// odometry frame is that of the body at the end of the first scan.
class Loam : public Estimator {
 public:
  Loam(const Config& config, const SensorRig& rig);

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
  ScanToScan odometry_;
  ScanToMap mapping_;
  int scans_ = 0;
  EstimatorResult result_;
};

}  // namespace aims::loam
