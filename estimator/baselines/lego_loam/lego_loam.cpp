// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lego_loam/lego_loam.hpp"

#include <limits>
#include <variant>

#include "estimator/baselines/lego_loam/scan_series.hpp"

namespace aims::lego_loam {

LegoLoam::LegoLoam(const Config& config, const SensorRig& rig)
    : config_(config),
      rig_(rig),
      queue_(config.queue, ImuPropagationConfig(), rig.imu_rate_hz,
             std::numeric_limits<double>::infinity()),
      odometry_(config.odometry),
      mapping_(config.mapping) {
  result_.diagnostics.series = scan_series();
}

void LegoLoam::consume(const Delivery& delivery) {
  queue_.push(delivery);
  process_ready();
}

void LegoLoam::finish() {
  queue_.close();
  process_ready();
}

void LegoLoam::process_ready() {
  while (const std::optional<Correction> next = queue_.pop()) {
    if (const auto* scan = std::get_if<LidarScanPtr>(&*next)) process(**scan);
  }
  if (const std::optional<Time> newest = queue_.imu().newest()) {
    queue_.imu().forget_before(*newest);
  }
  for (const auto& [name, count] : queue_.counts()) result_.counts[name] = count;
}

/// The first scan is only what the second one is registered to.
void LegoLoam::process(const LidarScan& scan) {
  SegmentedFeatures features =
      segmented_features(RangeImage(scan, config_.image), config_.image, config_.features);
  ScanReport report;
  report.points_in = features.features.points;
  report.ground = features.ground;
  report.segmented = features.segmented;
  report.odometry = odometry_.update(features.features);
  if (started_) report.mapping = mapping_.update(scan.end, odometry_.pose(), features);
  started_ = true;
  const Pose T_map_lidar = mapping_.to_map(odometry_.pose());
  const Pose T_odom_body = rig_.T_body_lidar * T_map_lidar * rig_.T_body_lidar.inverse();
  result_.trajectory.push_back({scan.end, T_odom_body});
  result_.diagnostics.scans.push_back(row_of(report, scan.end));
}

std::vector<Eigen::Vector3f> LegoLoam::map_points() const {
  std::vector<Eigen::Vector3f> points = mapping_.map().points();
  for (Eigen::Vector3f& point : points) {
    point = (rig_.T_body_lidar * point.cast<double>()).cast<float>();
  }
  return points;
}

}  // namespace aims::lego_loam
