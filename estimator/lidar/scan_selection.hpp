// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/measurements.hpp"
#include "estimator/aims/config.hpp"
#include "estimator/lidar/voxel_hash.hpp"

namespace aims {

/// Picks points of a raw scan evenly in space: one return of each voxel of the sensor frame, drawn
/// by a hash of its index. Far walls keep nearly every return, near ones a few.
/// The draw must not follow the firing order: the first return in a voxel is more often one that
/// range noise pushed into it, outwards on one side of the robot and inwards on the other, and the
/// map then turns with the sense in which the LiDAR spins.
class ScanSelection {
 public:
  explicit ScanSelection(const LidarUpdateConfig& config) : config_(config) {}

  /// Replaces `kept` by indices into `scan`, evenly thinned when there are more than `limit`.
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
  std::vector<Candidate> candidates_;
  VoxelHash taken_{8192};
};

}  // namespace aims
