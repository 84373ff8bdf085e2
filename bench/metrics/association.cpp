// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/association.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

constexpr double kFarthest = 1e6;  ///< [m]; beyond it squares and sums lose their meaning
constexpr double kNormTolerance = 1e-3;

/// The pose nearest in time, the earlier one of two equally near; `trajectory` is not empty.
const StampedPose& nearest(const Trajectory& trajectory, Time stamp) {
  const auto after =
      std::lower_bound(trajectory.begin(), trajectory.end(), stamp,
                       [](const StampedPose& each, Time time) { return each.stamp < time; });
  if (after == trajectory.begin()) return *after;
  const auto before = std::prev(after);
  if (after == trajectory.end()) return *before;
  return stamp - before->stamp <= after->stamp - stamp ? *before : *after;
}

std::vector<PosePair> associate_nearest(const Trajectory& estimate, const Trajectory& truth,
                                        Duration tolerance) {
  std::vector<PosePair> pairs;
  const bool truth_chooses = estimate.size() > truth.size();
  const Trajectory& shorter = truth_chooses ? truth : estimate;
  const Trajectory& longer = truth_chooses ? estimate : truth;
  for (const StampedPose& each : shorter) {
    const StampedPose& match = nearest(longer, each.stamp);
    if (std::abs(match.stamp - each.stamp) > tolerance) continue;
    const StampedPose& estimated = truth_chooses ? match : each;
    pairs.push_back({estimated.stamp, estimated.pose, truth_chooses ? each.pose : match.pose});
  }
  return pairs;
}

std::vector<PosePair> associate_interpolated(const Trajectory& estimate, const Trajectory& truth) {
  std::vector<PosePair> pairs;
  for (const StampedPose& each : estimate) {
    if (const auto true_pose = pose_at(truth, each.stamp)) {
      pairs.push_back({each.stamp, each.pose, *true_pose});
    }
  }
  return pairs;
}

}  // namespace

std::vector<PosePair> associate(const Trajectory& estimate, const Trajectory& truth,
                                Association association, Duration tolerance) {
  if (estimate.empty() || truth.empty()) return {};
  if (association == Association::kNearest) return associate_nearest(estimate, truth, tolerance);
  return associate_interpolated(estimate, truth);
}

std::optional<Duration> median_stamp_difference(const Trajectory& estimate,
                                                const Trajectory& truth) {
  std::vector<Duration> differences;
  for (const StampedPose& each : estimate) {
    const bool inside =
        !truth.empty() && each.stamp >= truth.front().stamp && each.stamp <= truth.back().stamp;
    if (inside) differences.push_back(std::abs(nearest(truth, each.stamp).stamp - each.stamp));
  }
  if (differences.empty()) return std::nullopt;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return *middle;
}

bool is_valid(const Pose& pose) {
  const bool finite = pose.translation.allFinite() && pose.rotation.coeffs().allFinite();
  return finite && pose.translation.norm() < kFarthest &&
         std::abs(pose.rotation.norm() - 1.0) < kNormTolerance;
}

Trajectory valid_part(const Trajectory& trajectory) {
  Trajectory valid;
  for (const StampedPose& each : trajectory) {
    if (!is_valid(each.pose)) continue;
    if (!valid.empty() && each.stamp <= valid.back().stamp) continue;
    valid.push_back(each);
  }
  return valid;
}

}  // namespace aims
