// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/scan_estimator.hpp"

#include <utility>

namespace aims::features {

ScanEstimator::ScanEstimator(const QueueConfig& queue, const SensorRig& rig,
                             std::vector<SeriesInfo> series, Duration imu_memory)
    : QueuedEstimator(queue, rig, std::move(series)), imu_memory_(imu_memory) {}

void ScanEstimator::end_delivery() {
  if (const std::optional<Time> newest = queue_.imu().newest()) {
    queue_.imu().forget_before(*newest - imu_memory_);
  }
}

void ScanEstimator::report(const Pose& T_map_lidar, Time end, std::vector<double> values) {
  const Pose T_odom_body = rig_.T_body_lidar * T_map_lidar * rig_.T_body_lidar.inverse();
  result_.trajectory.push_back({end, T_odom_body});
  result_.diagnostics.scans.push_back({end, std::nullopt, std::move(values)});
}

std::vector<Eigen::Vector3f> ScanEstimator::map_points() const {
  std::vector<Eigen::Vector3f> points = points_in_lidar_axes();
  for (Eigen::Vector3f& point : points) {
    point = (rig_.T_body_lidar * point.cast<double>()).cast<float>();
  }
  return points;
}

}  // namespace aims::features
