// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "estimator/baselines/features/feature_solver.hpp"
#include "estimator/baselines/features/scan_estimator.hpp"
#include "estimator/baselines/loam/config.hpp"
#include "estimator/baselines/loam/scan_to_map.hpp"
#include "estimator/baselines/loam/scan_to_scan.hpp"
#include "estimator/diagnostics.hpp"

namespace aims::loam {

/// What LOAM reports of a scan.
struct ScanReport {
  int points_in = 0;                              ///< finite returns in range
  int edges = 0;                                  ///< sharp features
  int planes = 0;                                 ///< flat features
  features::SolverResult odometry;                ///< scan to scan
  std::optional<features::SolverResult> mapping;  ///< none: the scan was not registered to the map
};

/// The series of its diagnostics.
std::vector<SeriesInfo> scan_series();

/// Its row, in the order of `scan_series`.
ScanRow row_of(const ScanReport& scan, Time stamp);

/// LOAM without IMU: edge and plane features, scan to scan odometry, registration to a map.
class Loam final : public features::ScanEstimator {
 public:
  Loam(const Config& config, const SensorRig& rig);

 private:
  void process(const LidarScan& scan) override;
  std::vector<Eigen::Vector3f> points_in_lidar_axes() const override { return mapping_.points(); }

  Config config_;
  ScanToScan odometry_;
  ScanToMap mapping_;
  int scans_ = 0;
};

}  // namespace aims::loam
