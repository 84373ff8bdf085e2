// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lego_loam/lego_loam.hpp"

#include "estimator/baselines/lego_loam/scan_series.hpp"

namespace aims::lego_loam {

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
