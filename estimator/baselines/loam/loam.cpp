// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/loam/loam.hpp"

#include <limits>
#include <variant>

#include "estimator/baselines/loam/scan_series.hpp"

namespace aims::loam {

Loam::Loam(const Config& config, const SensorRig& rig)
    : config_(config),
      rig_(rig),
      queue_(config.queue, ImuPropagationConfig(), rig.imu_rate_hz,
             std::numeric_limits<double>::infinity()),
      odometry_(config.odometry),
      mapping_(config.mapping) {
  result_.diagnostics.series = scan_series();
}

void Loam::consume(const Delivery& delivery) {
  queue_.push(delivery);
  process_ready();
}

void Loam::finish() {
  queue_.close();
  process_ready();
}

void Loam::process_ready() {
  while (const std::optional<Correction> next = queue_.pop()) {
    if (const auto* scan = std::get_if<LidarScanPtr>(&*next)) process(**scan);
  }
  if (const std::optional<Time> newest = queue_.imu().newest()) {
    queue_.imu().forget_before(*newest);
  }
  for (const auto& [name, count] : queue_.counts()) result_.counts[name] = count;
}

void Loam::process(const LidarScan& scan) {
  features::RingFeatures features = features::ring_features(scan, config_.features);
  ScanReport diagnostics;
  diagnostics.points_in = features.points;
  diagnostics.edges = static_cast<int>(features.sharp.size());
  diagnostics.planes = static_cast<int>(features.flat.size());
  diagnostics.odometry = odometry_.update(features);
  if (scans_++ % config_.mapping.interval == 0) {
    diagnostics.mapping = mapping_.update(odometry_.pose(), features);
  }
  const Pose T_map_lidar = mapping_.to_map(odometry_.pose());
  const Pose T_odom_body = rig_.T_body_lidar * T_map_lidar * rig_.T_body_lidar.inverse();
  result_.trajectory.push_back({scan.end, T_odom_body});
  result_.diagnostics.scans.push_back(row_of(diagnostics, scan.end));
}

std::vector<Eigen::Vector3f> Loam::map_points() const {
  std::vector<Eigen::Vector3f> points = mapping_.points();
  for (Eigen::Vector3f& point : points) {
    point = (rig_.T_body_lidar * point.cast<double>()).cast<float>();
  }
  return points;
}

}  // namespace aims::loam
