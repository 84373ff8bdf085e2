// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/trajectory.hpp"

namespace aims {

/// Poses at rising times, found by walking along the trajectory.
class PoseCursor {
 public:
  explicit PoseCursor(const Trajectory& trajectory) : trajectory_(trajectory) {}

  /// Interpolated; beyond the ends, the first or last pose.
  Pose at(Time stamp) {
    while (next_ < trajectory_.size() && trajectory_[next_].stamp < stamp) ++next_;
    if (next_ == trajectory_.size()) return trajectory_.back().pose;
    if (next_ == 0) return trajectory_.front().pose;
    const StampedPose& before = trajectory_[next_ - 1];
    const StampedPose& after = trajectory_[next_];
    const double fraction =
        to_seconds(stamp - before.stamp) / to_seconds(after.stamp - before.stamp);
    return interpolate(before.pose, after.pose, fraction);
  }

 private:
  const Trajectory& trajectory_;
  std::size_t next_ = 0;
};

}  // namespace aims
