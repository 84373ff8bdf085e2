// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/measurements.hpp"

namespace aims {

/// Puts the scans of a spinning LiDAR together from its blocks of firings: a scan ends where the
/// azimuth passes zero. The revolution that has begun before the first block is left out, unless
/// that block begins one.
class Revolutions {
 public:
  /// Begins the block at `azimuth`, over which the head turns by `turn` [0.01 deg]; returns the
  /// scan that it ends.
  std::optional<LidarScan> begin_block(int azimuth, int turn);

  /// Whether the present revolution is there from its start: points of others are left out.
  bool is_whole() const { return whole_; }

  /// Adds a return of the present revolution; its time offset is set from `time`.
  void add(LidarPoint point, Time time);

  /// The last scan, if it is complete.
  std::optional<LidarScan> finish();

 private:
  LidarScan scan_;
  int turn_ = 0;                ///< of the head over the last block [0.01 deg]
  bool whole_ = false;          ///< the present revolution began at its start
  std::optional<int> azimuth_;  ///< of the last block [0.01 deg]
};

}  // namespace aims
