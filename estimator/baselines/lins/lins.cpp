// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lins/lins.hpp"

#include <algorithm>

#include "estimator/baselines/lins/scan_series.hpp"

namespace aims::lins {
namespace {

/// A gap between scans that is longer is bridged by the sample after it.
constexpr Duration kImuMemory = 2 * kSecond;

}  // namespace

Lins::Lins(const Config& config, const SensorRig& rig)
    : ScanEstimator(config.queue, rig, scan_series(), kImuMemory),
      config_(config),
      R_lidar_body_(rig.T_body_lidar.R().transpose()),
      odometry_(config),
      mapping_(config.mapping) {}

/// The samples in memory up to the first one at or after `end`, LiDAR axes. As in the published
/// program the IMU is taken for a part of the LiDAR: no lever arm.
std::vector<ImuSample> Lins::samples_until(Time end) const {
  std::vector<ImuSample> samples;
  for (const ImuSample& sample : imu().samples()) {
    const bool covered = !samples.empty() && samples.back().stamp >= end;
    if (covered) break;
    samples.push_back(sample);
    samples.back().angular_velocity = R_lidar_body_ * sample.angular_velocity;
    samples.back().specific_force = R_lidar_body_ * sample.specific_force;
  }
  return samples;
}

void Lins::process(const LidarScan& scan) {
  const bool to_stamp = config_.filter.predict_until == PredictionEnd::kScanStamp;
  const Time until = to_stamp ? scan.stamp : scan.end;
  const std::vector<ImuSample> samples = samples_until(until);
  if (samples.empty() || samples.back().stamp < until) {
    count("lidar.without_imu");
    return;
  }
  lego_loam::SegmentedFeatures features = lego_loam::segmented_features(
      lego_loam::RangeImage(scan, config_.image), config_.image, config_.features);
  ScanReport diagnostics;
  diagnostics.points_in = features.features.points;
  diagnostics.ground = features.ground;
  diagnostics.segmented = features.segmented;
  diagnostics.odometry = odometry_.update(features.features, samples, samples.back(), until);
  using Outcome = OdometryResult::Outcome;
  const Outcome outcome = diagnostics.odometry.outcome;
  if (outcome == Outcome::kStarting) return;
  if (outcome == Outcome::kUnchanged) count("lidar.no_update");
  if (outcome == Outcome::kRegistered) count("filter.diverged");
  if (outcome == Outcome::kRejected) count("filter.rejected");
  // As published, the pose is on its way before the map has corrected it.
  const Pose T_map_lidar = mapping_.to_map(odometry_.pose());
  if (outcome != Outcome::kUnchanged && outcome != Outcome::kRejected) {
    diagnostics.mapping = mapping_.update(scan.stamp, odometry_.pose(), features);
  }
  diagnostics.loops = mapping_.loops();
  report(T_map_lidar, row_of(diagnostics, scan.end));
}

}  // namespace aims::lins
