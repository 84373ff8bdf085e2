// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/measurements.hpp"
#include "estimator/config.hpp"
#include "estimator/voxel_hash.hpp"

namespace aims {

/// Picks points of a raw scan evenly in space: the first return, in firing order, of each voxel of
/// the sensor frame. Far walls keep nearly every return, near ones a few.
class ScanSelection {
 public:
  explicit ScanSelection(const LidarUpdateConfig& config) : config_(config) {}

  /// Replaces `kept` by indices into `scan`, evenly thinned when there are more than `limit`.
  void select(const LidarScan& scan, double voxel, int limit, std::vector<int>& kept);

  /// True when the point is finite and in range.
  bool usable(const LidarPoint& point) const;

 private:
  LidarUpdateConfig config_;
  VoxelHash taken_{8192};
};

}  // namespace aims
