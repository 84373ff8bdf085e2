// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/time.hpp"

namespace aims {

/// Whether an estimate can be relied on, as the estimator itself sees it, without the truth.
enum class HealthState {
  kStarting,  ///< no pose yet
  kHealthy,
  kDegraded,  ///< a source is missing or contradicts another; the estimate goes on with the rest
  kInvalid,   ///< the estimate must not be used
};

/// Identifier for result files: "starting", "healthy", "degraded", "invalid".
constexpr std::string_view name_of(HealthState state) {
  constexpr std::string_view kNames[] = {"starting", "healthy", "degraded", "invalid"};
  return kNames[static_cast<int>(state)];
}

/// State and reasons from `stamp` to the stamp of the next row.
struct HealthRow {
  Time stamp = 0;
  HealthState state = HealthState::kStarting;
  std::vector<std::string> reasons;  ///< short phrases, none while healthy: "no leg odometry"
  double position_sigma = 0.0;       ///< stated, along the least certain axis [m]; NaN: none stated
};

/// Time between rows while state and reasons stay the same.
inline constexpr Duration kHealthInterval = kSecond;

/// Appends the row when its state or reasons are new, or `kHealthInterval` after the last.
inline void append_health(std::vector<HealthRow>& rows, HealthRow row) {
  const bool same = !rows.empty() && rows.back().state == row.state &&
                    rows.back().reasons == row.reasons &&
                    row.stamp - rows.back().stamp < kHealthInterval;
  if (!same) rows.push_back(std::move(row));
}

}  // namespace aims
