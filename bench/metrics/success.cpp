// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/success.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Keeps the earliest failure; of two at the same instant the first noted.
void note(SuccessVerdict& verdict, FailureReason reason, Time stamp) {
  verdict.partial = verdict.partial || is_lack_of_poses(reason);
  if (verdict.diverged_at && stamp >= *verdict.diverged_at) return;
  verdict.reason = reason;
  verdict.diverged_at = stamp;
}

void note_invalid_poses(SuccessVerdict& verdict, const Trajectory& estimate) {
  const auto invalid = std::find_if(estimate.begin(), estimate.end(),
                                    [](const StampedPose& each) { return !is_valid(each.pose); });
  if (invalid != estimate.end()) note(verdict, FailureReason::kInvalid, invalid->stamp);
}

void note_missing_poses(SuccessVerdict& verdict, const Trajectory& truth,
                        std::span<const PosePair> pairs, const SuccessLimits& limits) {
  if (pairs.front().stamp - truth.front().stamp > limits.edge) {
    note(verdict, FailureReason::kStartsLate, truth.front().stamp);
  }
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const Duration step = pairs[i].stamp - pairs[i - 1].stamp;
    if (step <= limits.gap) continue;
    if (step - time_in(limits.truth_gaps, pairs[i - 1].stamp, pairs[i].stamp) <= limits.gap) {
      continue;
    }
    note(verdict, FailureReason::kGap, pairs[i - 1].stamp);
    break;
  }
  if (truth.back().stamp - pairs.back().stamp > limits.edge) {
    note(verdict, FailureReason::kEndsEarly, pairs.back().stamp);
  }
}

/// Largest heading by which a fit turns the path against the attitude of the first pose. A mount
/// is off by less; a path that leads elsewhere is an error [rad].
constexpr double kMaxHeading = 0.1;

/// The heading that turns displacements from the start onto the true ones, by least squares.
class HeadingFit {
 public:
  void add(const Eigen::Vector3d& estimate, const Eigen::Vector3d& truth) {
    sine_ += estimate.x() * truth.y() - estimate.y() * truth.x();
    cosine_ += estimate.x() * truth.x() + estimate.y() * truth.y();
  }
  Eigen::Quaterniond rotation() const {
    return yaw_rotation(std::clamp(std::atan2(sine_, cosine_), -kMaxHeading, kMaxHeading));
  }

 private:
  double sine_ = 0.0;
  double cosine_ = 0.0;
};

void note_large_errors(SuccessVerdict& verdict, const Trajectory& truth,
                       std::span<const PosePair> pairs, const SuccessLimits& limits) {
  const Eigen::Vector3d start = pairs.front().truth.translation;
  HeadingFit heading;
  double path = 0.0;
  std::size_t last = 0;  // index into the truth up to which `path` is summed
  for (const PosePair& pair : pairs) {
    while (last + 1 < truth.size() && truth[last + 1].stamp <= pair.stamp) {
      path += (truth[last + 1].pose.translation - truth[last].pose.translation).norm();
      ++last;
    }
    const Eigen::Vector3d estimated = pair.estimate.translation - start;
    const Eigen::Vector3d truly = pair.truth.translation - start;
    heading.add(estimated, truly);
    const double error = (heading.rotation() * estimated - truly).norm();
    if (error <= std::max(limits.error_offset, limits.error_per_path * path)) continue;
    note(verdict, FailureReason::kErrorLimit, pair.stamp);
    return;
  }
}

}  // namespace

std::string_view name_of(FailureReason reason) {
  switch (reason) {
    case FailureReason::kNone:
      return "";
    case FailureReason::kNoPoses:
      return "no_poses";
    case FailureReason::kNoOverlap:
      return "no_overlap";
    case FailureReason::kInvalid:
      return "invalid_pose";
    case FailureReason::kStartsLate:
      return "starts_late";
    case FailureReason::kGap:
      return "gap";
    case FailureReason::kEndsEarly:
      return "ends_early";
    case FailureReason::kErrorLimit:
      return "error_limit";
    case FailureReason::kCoverage:
      return "low_coverage";
    case FailureReason::kInvalidRun:
      return "invalid_run";
    case FailureReason::kInterrupted:
      return "interrupted";
  }
  return "";
}

bool is_lack_of_poses(FailureReason reason) {
  switch (reason) {
    case FailureReason::kNone:
    case FailureReason::kErrorLimit:
    case FailureReason::kInvalidRun:
      return false;
    case FailureReason::kNoPoses:
    case FailureReason::kNoOverlap:
    case FailureReason::kInvalid:
    case FailureReason::kStartsLate:
    case FailureReason::kGap:
    case FailureReason::kEndsEarly:
    case FailureReason::kCoverage:
    case FailureReason::kInterrupted:
      return true;
  }
  return true;
}

SuccessVerdict judge(const Trajectory& estimate, const Trajectory& truth,
                     std::span<const PosePair> pairs, const SuccessLimits& limits) {
  if (estimate.empty()) return {FailureReason::kNoPoses, std::nullopt, true};
  SuccessVerdict verdict;
  note_invalid_poses(verdict, estimate);
  if (truth.empty() || pairs.size() < 2) {
    if (!verdict.diverged_at) {
      note(verdict, FailureReason::kNoOverlap, truth.empty() ? 0 : truth.front().stamp);
    }
    return verdict;
  }
  if (!limits.at_points) note_missing_poses(verdict, truth, pairs, limits);
  note_large_errors(verdict, truth, pairs, limits);
  if (coverage_of(pairs, truth, limits) < limits.coverage) {
    note(verdict, FailureReason::kCoverage, pairs.back().stamp);
  }
  return verdict;
}

double coverage_of(std::span<const PosePair> pairs, const Trajectory& truth, Duration gap,
                   std::span<const TruthGap> truth_gaps) {
  if (truth.size() < 2) return 0.0;
  Duration covered = 0;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    Duration step = pairs[i].stamp - pairs[i - 1].stamp;
    if (!truth_gaps.empty()) step -= time_in(truth_gaps, pairs[i - 1].stamp, pairs[i].stamp);
    if (step <= gap) covered += step;
  }
  const Time begin = truth.front().stamp;
  const Time end = truth.back().stamp;
  const Duration known = end - begin - time_in(truth_gaps, begin, end);
  return known > 0 ? to_seconds(covered) / to_seconds(known) : 0.0;
}

double coverage_of(std::span<const PosePair> pairs, const Trajectory& truth,
                   const SuccessLimits& limits) {
  if (!limits.at_points) return coverage_of(pairs, truth, limits.gap, limits.truth_gaps);
  if (truth.empty()) return 0.0;
  return static_cast<double>(pairs.size()) / static_cast<double>(truth.size());
}

double path_length(const Trajectory& trajectory) {
  double length = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    length += (trajectory[i].pose.translation - trajectory[i - 1].pose.translation).norm();
  }
  return length;
}

}  // namespace aims
