// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "bench/metrics/association.hpp"

namespace aims {

/// Why a run does not count as localized to its end.
enum class LostReason {
  kNone,        ///< it does
  kNoOverlap,   ///< fewer than two estimated poses in the truth's span
  kInvalid,     ///< a pose that is not finite, or not a pose
  kStartsLate,  ///< no estimate near the truth's begin
  kGap,         ///< no estimate for too long
  kEndsEarly,   ///< no estimate near the truth's end
  kErrorLimit,  ///< position error beyond the limit
};

/// A word for reports: "", "no_overlap", "invalid_pose", "starts_late", "gap", ...
std::string_view name_of(LostReason reason);

/// Limits of a run that counts as localized.
struct SuccessLimits {
  double error_offset = 1.0;     ///< allowed position error at the start [m]
  double error_per_path = 0.05;  ///< allowed position error per metre walked [-]
  Duration edge = 3 * kSecond;   ///< allowed lack of estimates at either end
  Duration gap = 2 * kSecond;    ///< allowed lack of estimates in between
};

/// When and why the estimate was lost; `lost_at` has a value exactly when there is a reason.
struct SuccessVerdict {
  LostReason reason = LostReason::kNone;
  std::optional<Time> lost_at;
};

/// The earliest loss of an estimate. `estimate` is as the estimator gave it, `pairs` are its valid
/// poses anchored at the start. An estimate is lost when its position error exceeds
/// error_offset + error_per_path * (true path walked so far), when it is missing at either end or
/// for too long, or when it holds an invalid pose.
SuccessVerdict judge(const Trajectory& estimate, const Trajectory& truth,
                     std::span<const PosePair> pairs, const SuccessLimits& limits);

/// Length [m] of the polygon through the positions.
double path_length(const Trajectory& trajectory);

}  // namespace aims
