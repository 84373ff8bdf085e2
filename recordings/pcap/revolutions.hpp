// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/measurements.hpp"

namespace aims {

/// Puts the scans of a spinning LiDAR together from its blocks of firings: a scan ends where the
/// azimuth passes zero. The revolution that has begun before the first block is left out, unless
/// that block begins one; where no other is complete, its end and the beginning of the next are one
/// scan, if they go all around. A block that lies less than 30 degrees before the furthest one
/// comes late, also across zero, and ends no scan; what it has of the revolution before is left
/// out.
class Revolutions {
 public:
  /// Begins the block at `azimuth`, over which the head turns by `turn` [0.01 deg]; returns the
  /// scan that it ends.
  std::optional<LidarScan> begin_block(int azimuth, int turn);

  /// Whether points of the present revolution may be part of a scan.
  bool is_wanted() const { return !overdue_ && (whole_ || !ended_); }

  /// Adds a return of the present revolution; its time offset is set from `time`.
  void add(LidarPoint point, Time time);

  /// The last scan, if it is complete.
  std::optional<LidarScan> finish();

  /// Fraction of the turning, between blocks, in which blocks are missing [0 to 1].
  double missing() const { return turned_ == 0 ? 0.0 : double(missed_) / double(turned_); }

 private:
  /// A return before the first revolution that is there from its start.
  struct Early {
    int azimuth = 0;  ///< of its block [0.01 deg]
    LidarPoint point;
    Time time = 0;
  };

  static void add_to(LidarScan& scan, LidarPoint point, Time time);
  std::optional<LidarScan> all_around();

  LidarScan scan_;
  std::vector<Early> early_;
  std::int64_t turned_ = 0;     ///< over all blocks [0.01 deg]
  std::int64_t missed_ = 0;     ///< of it without blocks [0.01 deg]
  int block_ = 0;               ///< azimuth of the present block [0.01 deg]
  int turn_ = 0;                ///< of the head over the last block [0.01 deg]
  bool whole_ = false;          ///< the present revolution began at its start
  bool ended_ = false;          ///< a scan was complete
  bool overdue_ = false;        ///< the present block is of the revolution before
  std::optional<int> azimuth_;  ///< of the furthest block [0.01 deg]
};

}  // namespace aims
