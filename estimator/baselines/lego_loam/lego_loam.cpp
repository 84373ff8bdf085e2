// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lego_loam/lego_loam.hpp"

#include <array>

#include "estimator/baselines/features/scan_estimator.hpp"

namespace aims::lego_loam {

namespace {

// Coordinates of the pose that each step moves; z is up.
features::PoseCoordinates roll_pitch_height() { return {0, 1, 5}; }
features::PoseCoordinates heading_and_plane() { return {2, 3, 4}; }

}  // namespace

OdometryResult TwoStepOdometry::solve(const features::RingFeatures& scan) const {
  OdometryResult result;
  result.ground.pose = motion_;
  result.edges.pose = motion_;
  if (static_cast<int>(edges_.size()) < config_.min_edges ||
      static_cast<int>(planes_.size()) < config_.min_planes) {
    return result;
  }
  const auto planes = [&](const Pose& motion) -> features::FeatureMatches {
    return {{}, plane_matches(scan.flat, motion, true, planes_, config_.matching)};
  };
  const auto lines = [&](const Pose& motion) -> features::FeatureMatches {
    return {line_matches(scan.sharp, motion, true, edges_, config_.matching), {}};
  };
  result.ground = features::solve_pose(motion_, planes, config_.solver, roll_pitch_height());
  result.edges =
      features::solve_pose(result.ground.pose, lines, config_.solver, heading_and_plane());
  return result;
}

OdometryResult TwoStepOdometry::update(features::RingFeatures& scan) {
  OdometryResult result;
  if (started_) {
    result = solve(scan);
    motion_ = features::plausible_motion(result.edges.pose) ? result.edges.pose : Pose();
    T_odom_lidar_ = T_odom_lidar_ * motion_;
    T_odom_lidar_.rotation.normalize();
  }
  move_to_scan_end(scan.less_sharp, motion_);
  move_to_scan_end(scan.less_flat, motion_);
  edges_.set(scan.less_sharp);
  planes_.set(scan.less_flat);
  started_ = true;
  return result;
}

namespace {

/// What LeGO-LOAM reports of a scan.
struct ScanReport : features::SegmentedReport {
  OdometryResult odometry;
};

using Series = ReportedSeries<ScanReport>;

int iterations(const ScanReport& scan) {
  const int mapping = scan.mapping ? scan.mapping->iterations : 0;
  return scan.odometry.ground.iterations + scan.odometry.edges.iterations + mapping;
}

constexpr std::array kOwnSeries = {
    Series{"iterations", "-", "of odometry and mapping; 0: no update",
           [](const ScanReport& s) { return double(iterations(s)); }},
    Series{"ground_matches", "-", "planes of the last scan, first step of the odometry",
           [](const ScanReport& s) { return double(s.odometry.ground.planes); }},
    Series{"edge_matches", "-", "lines of the last scan, second step of the odometry",
           [](const ScanReport& s) { return double(s.odometry.edges.lines); }},
    Series{"ground_smallest_eigenvalue", "-",
           "smallest eigenvalue of A^T A in the first iteration: roll, pitch, height",
           [](const ScanReport& s) { return smallest_eigenvalue(s.odometry.ground); }},
    Series{"edge_smallest_eigenvalue", "-",
           "smallest eigenvalue of A^T A in the first iteration: heading, horizontal position",
           [](const ScanReport& s) { return smallest_eigenvalue(s.odometry.edges); }},
    Series{"odometry_removed_directions", "-", "degenerate directions that do not move, both steps",
           [](const ScanReport& s) {
             return double(s.odometry.ground.directions.removed +
                           s.odometry.edges.directions.removed);
           }},
};

constexpr std::array kSeries =
    joined(features::segmentation_series<ScanReport>(), kOwnSeries,
           features::mapping_series<ScanReport>(), features::loop_series<ScanReport>());

}  // namespace

LegoLoam::LegoLoam(const Config& config, const SensorRig& rig)
    : ScanEstimator(config.queue, rig, series_of(kSeries)),
      config_(config),
      odometry_(config.odometry),
      mapping_(config.mapping) {}

/// The first scan is only what the second one is registered to.
void LegoLoam::process(const LidarScan& scan) {
  SegmentedFeatures features =
      segmented_features(RangeImage(scan, config_.image), config_.image, config_.features);
  ScanReport diagnostics;
  diagnostics.points_in = features.features.points;
  diagnostics.ground = features.ground;
  diagnostics.segmented = features.segmented;
  diagnostics.odometry = odometry_.update(features.features);
  if (started_) diagnostics.mapping = mapping_.update(scan.end, odometry_.pose(), features);
  started_ = true;
  diagnostics.loops = mapping_.loops();
  report(mapping_.to_map(odometry_.pose()), scan.end, values_of(kSeries, diagnostics));
}

}  // namespace aims::lego_loam
