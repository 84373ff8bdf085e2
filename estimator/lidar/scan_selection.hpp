// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/measurements.hpp"
#include "estimator/lidar/lidar_config.hpp"
#include "estimator/lidar/range_steps.hpp"
#include "estimator/lidar/voxel_hash.hpp"

namespace aims {

/// Selects points of a raw scan evenly in space: one return per voxel of the sensor frame, chosen
/// by a hash of its index. Far walls keep nearly every return, near ones a few. The choice must not
/// follow the firing order: the first return in a voxel is more often one with range noise into it,
/// outward on one side of the robot and inward on the other, and the map then rotates with the
/// direction in which the LiDAR spins.
class ScanSelection {
 public:
  explicit ScanSelection(const LidarUpdateConfig& config) : config_(config) {}

  /// Lists the returns of `scan` to select from: the usable ones that are not mixed.
  void begin(const LidarScan& scan);

  /// Replaces `kept` by indices into `scan`, thinned evenly to at most `limit`. `scan` is the one
  /// of the last begin().
  void select(const LidarScan& scan, double voxel, int limit, std::vector<int>& kept);

  /// True when the point is finite and in range.
  bool usable(const LidarPoint& point) const;

 private:
  struct Candidate {
    std::uint64_t key = 0;
    std::int32_t index = 0;
  };

  void list_candidates(const LidarScan& scan, double voxel);

  LidarUpdateConfig config_;
  RangeSteps steps_;
  std::vector<std::int32_t> eligible_;  ///< indices into the scan
  std::vector<Candidate> candidates_;
  VoxelHash occupied_{8192};
};

}  // namespace aims
