// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/measurements.hpp"
#include "estimator/lidar/lidar_config.hpp"
#include "estimator/lidar/range_steps.hpp"

namespace aims {

/// Selects points of a raw scan evenly in space: one return per voxel of the sensor frame, chosen
/// by a hash of its index. Far walls keep nearly every return, near ones a few. The choice must not
/// follow the firing order: the first return in a voxel is more often one with range noise into it,
/// outward on one side of the robot and inward on the other, and the map then rotates with the
/// direction in which the LiDAR spins.
class ScanSelection {
 public:
  explicit ScanSelection(const LidarUpdateConfig& config) : config_(config) {}

  /// Lists the returns of `scan` to select from: the usable ones that are not mixed. Returns how
  /// many are usable, mixed or not.
  int begin(const LidarScan& scan);

  /// Replaces `kept` by indices into the scan of the last begin(), thinned evenly to at most
  /// `limit`. Chooses among the returns that the selection before left, one per voxel: nearly the
  /// same choice as among all when its voxels were smaller.
  void select(double voxel, int limit, std::vector<int>& kept);

  /// Replaces `kept` by indices of returns of the last begin(), in order of firing: all, or every
  /// n-th where these are more than `limit`. So they lie evenly over the directions of the scan.
  void thin(int limit, std::vector<int>& kept) const;

  /// True when the point is finite and in range.
  bool usable(const LidarPoint& point) const;

 private:
  struct Candidate {
    Eigen::Vector3f position;
    std::int32_t index = 0;  ///< into the scan
  };
  struct Kept {
    std::uint64_t key = 0;   ///< of its voxel
    std::uint64_t rank = 0;  ///< the lowest of a voxel is kept
    Candidate candidate;
  };
  static constexpr std::int32_t kFree = -1;

  static std::uint64_t key_of(const Candidate& candidate, float inverse_size);
  std::int32_t& slot_of(std::uint64_t key, std::size_t home);
  void keep(const Candidate& candidate, std::uint64_t key, std::int32_t& slot);

  LidarUpdateConfig config_;
  RangeSteps steps_;
  std::vector<Candidate> eligible_;
  std::vector<Kept> kept_;           ///< of the present selection, in order of their voxels
  std::vector<std::int32_t> slots_;  ///< into `kept_`, by the hash of the voxel; the next if taken
};

}  // namespace aims
