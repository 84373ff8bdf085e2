// SPDX-License-Identifier: BSD-3-Clause
#include "core/trajectory.hpp"

#include <algorithm>

namespace aims {

std::optional<Pose> pose_at(const Trajectory& trajectory, Time stamp) {
  const auto after =
      std::lower_bound(trajectory.begin(), trajectory.end(), stamp,
                       [](const StampedPose& each, Time time) { return each.stamp < time; });
  if (after == trajectory.end()) return std::nullopt;
  if (after->stamp == stamp) return after->pose;
  if (after == trajectory.begin()) return std::nullopt;
  const StampedPose& before = *std::prev(after);
  const double fraction =
      to_seconds(stamp - before.stamp) / to_seconds(after->stamp - before.stamp);
  return interpolate(before.pose, after->pose, fraction);
}

Trajectory thinned(const Trajectory& trajectory, Duration spacing) {
  Trajectory kept;
  for (const StampedPose& each : trajectory) {
    if (kept.empty() || each.stamp >= kept.back().stamp + spacing) kept.push_back(each);
  }
  return kept;
}

}  // namespace aims
