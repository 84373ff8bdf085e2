// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "bench/metrics/association.hpp"

namespace aims {

/// Why an estimate is not a success.
enum class FailureReason {
  kNone,         ///< success
  kNoPoses,      ///< the estimator never returned a pose
  kNoOverlap,    ///< fewer than two estimated poses in the time span of the truth
  kInvalid,      ///< a pose that is not finite or not a rigid transform
  kStartsLate,   ///< no estimate near the start of the truth
  kGap,          ///< a gap without estimates that is too long
  kEndsEarly,    ///< no estimate near the end of the truth
  kErrorLimit,   ///< position error beyond the limit
  kCoverage,     ///< too little of the truth's time has an estimate
  kInvalidRun,   ///< the robot did not finish its route, so that nothing is a success
  kInterrupted,  ///< the user ended it
};

/// Identifier for result files: "", "no_poses", "no_overlap", "invalid_pose", "starts_late", "gap",
/// ...
std::string_view name_of(FailureReason reason);

/// Allowed position error per metre of path of a success, and of one within 1 % [-].
inline constexpr double kSuccessErrorPerPath = 0.05;
inline constexpr double kStrictErrorPerPath = 0.01;

/// Limits of a success.
struct SuccessLimits {
  double error_offset = 0.5;                     ///< allowed position error in any case [m]
  double error_per_path = kSuccessErrorPerPath;  ///< per metre of path [-]
  Duration edge = 3 * kSecond;                   ///< allowed time without estimates at either end
  Duration gap = 2 * kSecond;                    ///< allowed time without estimates in between
  double coverage = 0.5;                  ///< least fraction of the truth's time with estimates [-]
  std::vector<TruthGap> truth_gaps = {};  ///< stretches without truth: nothing is missing there
  bool at_points = false;  ///< the truth is a list of points: what counts is how many are reached
};

/// When and why an estimate failed; `diverged_at` has a value exactly when there is a reason that
/// lies in the estimate.
struct SuccessVerdict {
  FailureReason reason = FailureReason::kNone;  ///< the earliest
  std::optional<Time> diverged_at;
  bool partial = false;  ///< poses are missing or invalid, whatever failed first
};

/// Whether that reason is that poses are missing or invalid.
bool is_lack_of_poses(FailureReason reason);

/// The earliest failure of an estimate. `estimate` is the output of the estimator, `pairs` are its
/// valid poses aligned at the start. An estimate fails when its position error exceeds both
/// error_offset and error_per_path * (true path so far), when it is missing at either end or for
/// longer than `gap`, when it contains an invalid pose, or when it covers too little of the truth.
/// The error is that of the displacement from the start, after the rotation about the vertical, of
/// at most 0.1 rad, that fits the displacements so far best: the heading is a gauge freedom, and
/// what comes later does not decide when an estimate failed.
SuccessVerdict judge(const Trajectory& estimate, const Trajectory& truth,
                     std::span<const PosePair> pairs, const SuccessLimits& limits);

/// Fraction of the truth's time, without its gaps, that lies between estimates at most `gap` apart.
double coverage_of(std::span<const PosePair> pairs, const Trajectory& truth, Duration gap,
                   std::span<const TruthGap> truth_gaps = {});

/// The same by the rules of `limits`; of points, the fraction with an estimate.
double coverage_of(std::span<const PosePair> pairs, const Trajectory& truth,
                   const SuccessLimits& limits);

/// Length [m] of the polygon through the positions.
double path_length(const Trajectory& trajectory);

}  // namespace aims
