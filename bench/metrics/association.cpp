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
  pairs.reserve(estimate.size());
  for (const StampedPose& each : estimate) {
    if (const auto true_pose = pose_at(truth, each.stamp)) {
      pairs.push_back({each.stamp, each.pose, *true_pose});
    }
  }
  return pairs;
}

std::vector<PosePair> associate_at_truth(const Trajectory& estimate, const Trajectory& truth,
                                         Duration longest) {
  std::vector<PosePair> pairs;
  for (const StampedPose& each : truth) {
    const auto after =
        std::lower_bound(estimate.begin(), estimate.end(), each.stamp,
                         [](const StampedPose& pose, Time time) { return pose.stamp < time; });
    if (after == estimate.end()) continue;
    const bool exact = after->stamp == each.stamp;
    if (!exact && after == estimate.begin()) continue;
    if (!exact && after->stamp - std::prev(after)->stamp > longest) continue;
    pairs.push_back({each.stamp, *pose_at(estimate, each.stamp), each.pose});
  }
  return pairs;
}

}  // namespace

std::vector<PosePair> associate(const Trajectory& estimate, const Trajectory& truth,
                                Association association, Duration tolerance) {
  if (estimate.empty() || truth.empty()) return {};
  if (association == Association::kNearest) return associate_nearest(estimate, truth, tolerance);
  if (association == Association::kAtTruth) return associate_at_truth(estimate, truth, tolerance);
  return associate_interpolated(estimate, truth);
}

std::vector<TruthGap> gaps_in(const Trajectory& truth, Duration longest) {
  std::vector<TruthGap> gaps;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const TruthGap gap{truth[i - 1].stamp, truth[i].stamp};
    if (gap.end - gap.begin > longest) gaps.push_back(gap);
  }
  return gaps;
}

Duration time_in(std::span<const TruthGap> gaps, Time begin, Time end) {
  Duration total = 0;
  for (const TruthGap& gap : gaps) {
    total += std::max<Duration>(0, std::min(gap.end, end) - std::max(gap.begin, begin));
  }
  return total;
}

std::vector<PosePair> outside(std::span<const TruthGap> gaps, std::vector<PosePair> pairs) {
  std::erase_if(pairs, [gaps](const PosePair& pair) {
    const auto gap = std::ranges::upper_bound(gaps, pair.stamp, {}, &TruthGap::end);
    return gap != gaps.end() && gap->begin < pair.stamp && pair.stamp < gap->end;
  });
  return pairs;
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

ValidPart::ValidPart(const Trajectory& trajectory) {
  std::optional<Time> last;
  const bool all = std::ranges::all_of(trajectory, [&last](const StampedPose& each) {
    const bool later = !last || each.stamp > *last;
    last = each.stamp;
    return later && is_valid(each.pose);
  });
  if (all) whole_ = &trajectory;
  if (!all) part_ = valid_part(trajectory);
}

Trajectory valid_part(const Trajectory& trajectory) {
  Trajectory valid;
  valid.reserve(trajectory.size());
  for (const StampedPose& each : trajectory) {
    if (!is_valid(each.pose)) continue;
    if (!valid.empty() && each.stamp <= valid.back().stamp) continue;
    valid.push_back(each);
  }
  return valid;
}

}  // namespace aims
