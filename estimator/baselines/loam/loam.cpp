// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/loam/loam.hpp"

#include <array>

#include "estimator/baselines/features/scan_estimator.hpp"

namespace aims::loam {

namespace {

using Series = ReportedSeries<ScanReport>;

constexpr std::array kOwnSeries = {
    Series{"points_in", "-", "finite points in range",
           [](const ScanReport& s) { return double(s.points_in); }},
    Series{"edges", "-", "sharp features", [](const ScanReport& s) { return double(s.edges); }},
    Series{"planes", "-", "flat features", [](const ScanReport& s) { return double(s.planes); }},
    Series{"iterations", "-", "of odometry and mapping; 0: no update",
           [](const ScanReport& s) {
             return double(s.odometry.iterations + (s.mapping ? s.mapping->iterations : 0));
           }},
    Series{"odometry_matches", "-", "lines and planes of the last scan",
           [](const ScanReport& s) { return double(s.odometry.lines + s.odometry.planes); }},
    Series{"odometry_smallest_eigenvalue", "-",
           "smallest eigenvalue of A^T A in the first iteration, scan to scan",
           [](const ScanReport& s) { return smallest_eigenvalue(s.odometry); }},
    Series{"odometry_removed_directions", "-", "degenerate directions that do not move",
           [](const ScanReport& s) { return double(s.odometry.directions.removed); }},
};

constexpr std::array kSeries = joined(kOwnSeries, features::mapping_series<ScanReport>());

}  // namespace

std::vector<SeriesInfo> scan_series() { return series_of(kSeries); }

ScanRow row_of(const ScanReport& scan, Time stamp) {
  return {stamp, std::nullopt, values_of(kSeries, scan)};
}

Loam::Loam(const Config& config, const SensorRig& rig)
    : ScanEstimator(config.queue, rig, scan_series()),
      config_(config),
      odometry_(config.odometry),
      mapping_(config.mapping) {}

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
  report(mapping_.to_map(odometry_.pose()), row_of(diagnostics, scan.end));
}

}  // namespace aims::loam
