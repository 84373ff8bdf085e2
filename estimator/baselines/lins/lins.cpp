// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lins/lins.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "estimator/baselines/features/scan_estimator.hpp"
#include "estimator/baselines/points/translation_constraint.hpp"

namespace aims::lins {

namespace {

/// What LINS reports of a scan.
struct ScanReport : features::SegmentedReport {
  OdometryResult odometry;
};

using Series = ReportedSeries<ScanReport>;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

int iterations(const ScanReport& scan) {
  const int mapping = scan.mapping ? scan.mapping->iterations : 0;
  return scan.odometry.update.iterations + mapping;
}

points::TranslationConstraint constraint_of(const Update& update) {
  const std::vector<Eigen::Vector3d>& gradients = update.last.gradients;
  Eigen::Matrix<double, Eigen::Dynamic, 3> rows(static_cast<Eigen::Index>(gradients.size()), 3);
  for (std::size_t i = 0; i < gradients.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) = gradients[i].transpose();
  }
  return points::translation_constraint(rows);
}

double residual_rms(const Update& update) {
  const std::size_t count = update.last.gradients.size();
  return count > 0 ? std::sqrt(update.last.squared_norm / static_cast<double>(count)) : kNone;
}

constexpr std::array kOwnSeries = {
    Series{"iterations", "-", "of filter and mapping; 0: no update",
           [](const ScanReport& s) { return double(iterations(s)); }},
    Series{"filter_iterations", "-", "of the filter",
           [](const ScanReport& s) { return double(s.odometry.update.iterations); }},
    Series{"converged", "-", "1: the filter's last step was small",
           [](const ScanReport& s) { return s.odometry.update.converged ? 1.0 : 0.0; }},
    Series{"diverged", "-", "1: the filter diverged, the scans alone gave the motion",
           [](const ScanReport& s) { return s.odometry.update.diverged ? 1.0 : 0.0; }},
    Series{"plane_matches", "-", "planes of the last scan in the last iteration",
           [](const ScanReport& s) { return double(s.odometry.update.last.planes); }},
    Series{"edge_matches", "-", "lines of the last scan in the last iteration",
           [](const ScanReport& s) { return double(s.odometry.update.last.lines); }},
    Series{"residual_rms", "m", "weighted distances in the last iteration",
           [](const ScanReport& s) { return residual_rms(s.odometry.update); }},
    Series{"points_used", "-", "distances that weigh enough in the last iteration",
           [](const ScanReport& s) { return double(s.odometry.update.last.gradients.size()); }},
    Series{"smallest_eigenvalue", "-",
           "smallest eigenvalue of the sum of squared gradients in the last iteration: translation",
           [](const ScanReport& s) { return constraint_of(s.odometry.update).smallest; }},
    Series{"condition_number", "-", "condition number of that sum",
           [](const ScanReport& s) { return constraint_of(s.odometry.update).condition; }},
    Series{"localizability", "-", "sum of the cosines between gradients and the weakest direction",
           [](const ScanReport& s) { return constraint_of(s.odometry.update).localizability; }},
};

constexpr std::array kSeries =
    joined(features::segmentation_series<ScanReport>(), kOwnSeries,
           features::mapping_series<ScanReport>(), features::loop_series<ScanReport>());

/// A gap between scans that is longer is bridged by the sample after it.
constexpr Duration kImuMemory = 2 * kSecond;

}  // namespace

Lins::Lins(const Config& config, const SensorRig& rig)
    : ScanEstimator(config.queue, rig, series_of(kSeries), kImuMemory),
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
  report(T_map_lidar, scan.end, values_of(kSeries, diagnostics));
}

}  // namespace aims::lins
