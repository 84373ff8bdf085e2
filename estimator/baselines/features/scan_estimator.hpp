// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "estimator/estimator.hpp"
#include "estimator/filter/measurement_queue.hpp"

namespace aims::features {

/// An estimator that reads scans alone and reports a pose after each of them. The odometry frame is
/// that of the body at the end of the first scan.
class ScanEstimator : public Estimator {
 public:
  ScanEstimator(const QueueConfig& queue, const SensorRig& rig, std::vector<SeriesInfo> series);

  void consume(const Delivery& delivery) override;
  void finish() override;
  const EstimatorResult& result() const override { return result_; }
  std::vector<Eigen::Vector3f> map_points() const override;

 protected:
  /// Registers the scans in order of time; each call reports once.
  virtual void process(const LidarScan& scan) = 0;

  /// Points of the map, in the LiDAR's axes at the end of the first scan [m].
  virtual std::vector<Eigen::Vector3f> points_in_lidar_axes() const = 0;

  /// Adds the pose of the LiDAR at the end of a scan, relative to that at the end of the first one.
  void report(const Pose& T_map_lidar, ScanRow row);

 private:
  void process_ready();

  SensorRig rig_;
  MeasurementQueue queue_;
  EstimatorResult result_;
};

}  // namespace aims::features
