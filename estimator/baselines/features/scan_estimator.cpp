// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/scan_estimator.hpp"

#include <limits>
#include <utility>
#include <variant>

namespace aims::features {

ScanEstimator::ScanEstimator(const QueueConfig& queue, const SensorRig& rig,
                             std::vector<SeriesInfo> series, Duration imu_memory)
    : rig_(rig),
      imu_memory_(imu_memory),
      queue_(queue, ImuPropagationConfig(), rig.imu_rate_hz,
             std::numeric_limits<double>::infinity()) {
  result_.diagnostics.series = std::move(series);
}

void ScanEstimator::consume(const Delivery& delivery) {
  queue_.push(delivery);
  process_ready();
}

void ScanEstimator::finish() {
  queue_.close();
  process_ready();
}

void ScanEstimator::process_ready() {
  while (const std::optional<Correction> next = queue_.pop()) {
    if (const auto* scan = std::get_if<LidarScanPtr>(&*next)) process(**scan);
  }
  if (const std::optional<Time> newest = queue_.imu().newest()) {
    queue_.imu().forget_before(*newest - imu_memory_);
  }
  for (const auto& [name, count] : queue_.counts()) result_.counts[name] = count;
}

void ScanEstimator::report(const Pose& T_map_lidar, ScanRow row) {
  const Pose T_odom_body = rig_.T_body_lidar * T_map_lidar * rig_.T_body_lidar.inverse();
  result_.trajectory.push_back({row.stamp, T_odom_body});
  result_.diagnostics.scans.push_back(std::move(row));
}

std::vector<Eigen::Vector3f> ScanEstimator::map_points() const {
  std::vector<Eigen::Vector3f> points = points_in_lidar_axes();
  for (Eigen::Vector3f& point : points) {
    point = (rig_.T_body_lidar * point.cast<double>()).cast<float>();
  }
  return points;
}

}  // namespace aims::features
