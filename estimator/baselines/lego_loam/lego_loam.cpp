// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lego_loam/lego_loam.hpp"

#include <array>

#include "estimator/baselines/features/scan_estimator.hpp"

namespace aims::lego_loam {

namespace {

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

std::vector<SeriesInfo> scan_series() { return series_of(kSeries); }

ScanRow row_of(const ScanReport& scan, Time stamp) {
  return {stamp, std::nullopt, values_of(kSeries, scan)};
}

LegoLoam::LegoLoam(const Config& config, const SensorRig& rig)
    : ScanEstimator(config.queue, rig, scan_series()),
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
  report(mapping_.to_map(odometry_.pose()), row_of(diagnostics, scan.end));
}

}  // namespace aims::lego_loam
