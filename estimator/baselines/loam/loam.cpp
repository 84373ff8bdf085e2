// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/loam/loam.hpp"

#include "estimator/baselines/loam/scan_series.hpp"

namespace aims::loam {

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
