// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/success.hpp"

#include <algorithm>

namespace aims {
namespace {

/// Keeps the earliest loss; of two at the same instant the first noted.
void note(SuccessVerdict& verdict, LostReason reason, Time stamp) {
  if (!verdict.lost_at || stamp < *verdict.lost_at) verdict = {reason, stamp};
}

void note_invalid_poses(SuccessVerdict& verdict, const Trajectory& estimate) {
  const auto invalid = std::find_if(estimate.begin(), estimate.end(),
                                    [](const StampedPose& each) { return !is_valid(each.pose); });
  if (invalid != estimate.end()) note(verdict, LostReason::kInvalid, invalid->stamp);
}

void note_missing_poses(SuccessVerdict& verdict, const Trajectory& truth,
                        std::span<const PosePair> pairs, const SuccessLimits& limits) {
  if (pairs.front().stamp - truth.front().stamp > limits.edge) {
    note(verdict, LostReason::kStartsLate, truth.front().stamp);
  }
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    if (pairs[i].stamp - pairs[i - 1].stamp <= limits.gap) continue;
    note(verdict, LostReason::kGap, pairs[i - 1].stamp);
    break;
  }
  if (truth.back().stamp - pairs.back().stamp > limits.edge) {
    note(verdict, LostReason::kEndsEarly, pairs.back().stamp);
  }
}

void note_large_errors(SuccessVerdict& verdict, const Trajectory& truth,
                       std::span<const PosePair> pairs, const SuccessLimits& limits) {
  double path = 0.0;
  std::size_t walked = 0;  // index into the truth up to which `path` is summed
  for (const PosePair& pair : pairs) {
    while (walked + 1 < truth.size() && truth[walked + 1].stamp <= pair.stamp) {
      path += (truth[walked + 1].pose.translation - truth[walked].pose.translation).norm();
      ++walked;
    }
    const double error = (pair.estimate.translation - pair.truth.translation).norm();
    if (error <= limits.error_offset + limits.error_per_path * path) continue;
    note(verdict, LostReason::kErrorLimit, pair.stamp);
    return;
  }
}

}  // namespace

std::string_view name_of(LostReason reason) {
  switch (reason) {
    case LostReason::kNone:
      return "";
    case LostReason::kNoOverlap:
      return "no_overlap";
    case LostReason::kInvalid:
      return "invalid_pose";
    case LostReason::kStartsLate:
      return "starts_late";
    case LostReason::kGap:
      return "gap";
    case LostReason::kEndsEarly:
      return "ends_early";
    case LostReason::kErrorLimit:
      return "error_limit";
  }
  return "";
}

SuccessVerdict judge(const Trajectory& estimate, const Trajectory& truth,
                     std::span<const PosePair> pairs, const SuccessLimits& limits) {
  SuccessVerdict verdict;
  note_invalid_poses(verdict, estimate);
  if (truth.empty() || pairs.size() < 2) {
    if (!verdict.lost_at) {
      note(verdict, LostReason::kNoOverlap, truth.empty() ? 0 : truth.front().stamp);
    }
    return verdict;
  }
  note_missing_poses(verdict, truth, pairs, limits);
  note_large_errors(verdict, truth, pairs, limits);
  return verdict;
}

double path_length(const Trajectory& trajectory) {
  double length = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    length += (trajectory[i].pose.translation - trajectory[i - 1].pose.translation).norm();
  }
  return length;
}

}  // namespace aims
