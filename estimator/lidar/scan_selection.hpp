// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/measurements.hpp"
#include "estimator/lidar/float4.hpp"
#include "estimator/lidar/lidar_config.hpp"
#include "estimator/lidar/mixed_pixel_filter.hpp"

namespace aims {

/// Selects points of a raw scan evenly in space: one return per voxel of the sensor frame, chosen
/// by a hash of its index. Far walls keep nearly every return, near ones a few. The choice must not
/// follow the firing order: the first return in a voxel is more often one with range noise into it,
/// outward on one side of the robot and inward on the other, and the map then rotates with the
/// direction in which the LiDAR spins. The voxels move from scan to scan: of a wall near a border
/// between two, the returns that noise pushes across it count as much as all the others, so that it
/// would always seem to lie off to that side.
class ScanSelection {
 public:
  explicit ScanSelection(const LidarUpdateConfig& config) : config_(config) {}

  /// Lists the returns of `scan` to select from: the usable ones that are not at a step in range.
  /// Returns how many are usable, at a step or not. The scan must exist while returns are selected.
  int begin(const LidarScan& scan);

  /// Replaces `kept` by indices into the scan of the last begin(), thinned evenly to at most
  /// `limit`. Chooses among the returns that the selection before left, one per voxel: nearly the
  /// same choice as among all when its voxels were smaller.
  void select(double voxel, int limit, std::vector<int>& kept);

  /// Replaces `kept` by indices of returns of the last begin(), in order of firing: all, or every
  /// n-th where these are more than `limit`. So they lie evenly over the directions of the scan.
  void thin(int limit, std::vector<int>& kept) const;

  /// How far the voxels of this scan are moved, in their edges [0, 1), by axis.
  const std::array<double, 3>& grid_shift() const { return grid_shift_; }

  /// True when the point is finite and in range.
  bool usable(const LidarPoint& point) const;

 private:
  /// A return that is kept, and its voxel: the three coordinates of the voxel, then the index.
  using Kept = Int4;
  /// The last run of a ring, which its next return may belong to.
  struct Run {
    Int4 voxel = Int4{} + std::numeric_limits<std::int32_t>::min();  ///< three coordinates
    std::uint64_t lowest = 0;                                        ///< rank of a return in it
    std::uint64_t index = 0;                                         ///< of that return
    std::size_t place = 0;                                           ///< in `runs_`
  };
  static constexpr std::int32_t kFree = -1;

  void shift_grid();
  std::size_t keep_one_per_run(float inverse_size);
  void keep_one_per_voxel(std::span<const Kept> runs);

  LidarUpdateConfig config_;
  MixedPixelFilter steps_;
  const LidarScan* scan_ = nullptr;
  std::array<double, 3> grid_shift_{};    ///< of the voxels, in their edges, by axis
  std::vector<std::int32_t> candidates_;  ///< returns to select from
  std::vector<Kept> runs_;                ///< of neighbours of a ring in one voxel; room for more
  std::size_t ring_count_ = 0;            ///< one more than the highest ring of the scan
  std::vector<Run> last_;                 ///< of each ring
  std::vector<Kept> kept_;                ///< of the selection, in order of their voxels
  std::vector<std::int32_t> slots_;  ///< into `kept_`, by the hash of the voxel; the next if taken
};

}  // namespace aims
