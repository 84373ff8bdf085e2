// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/metrics/statistics.hpp"
#include "bench/tuning/effect.hpp"
#include "bench/tuning/objective.hpp"
#include "core/error.hpp"

namespace aims {

/// The best of the points that were run, the defaults included, with 95 % bootstrap intervals over
/// seeds, each resampled with all its scenarios. They are empty for one seed, and too narrow for a
/// few.
struct BestPoint {
  std::size_t point = kDefaults;  ///< kDefaults: no other is better
  std::vector<double> values;     ///< of each parameter
  /// Of each parameter: interval of the best value; empty of one without effect.
  std::vector<Interval> between;
  std::vector<bool> without_effect;  ///< of each parameter (effect.hpp)
  double objective = 0.0;
  Interval objective_interval;
  std::optional<double> defaults;  ///< objective of the default setting
  std::optional<double> gain;      ///< reduction of the objective, as a fraction of the defaults'
  bool defaults_diverged = false;  ///< every run with the defaults: there is no gain
  Interval gain_interval;
  std::vector<double> distance;  ///< best minus defaults per parameter, in widths of its range

  bool is_default() const { return point == kDefaults; }
};

/// Whether points differ by more than seeds do and, unless the best has the defaults or every run
/// with these diverged, the interval of its gain over them excludes zero.
bool is_resolved(const BestPoint& best, const Effect& effect);

/// "; points differ, but the gain over the defaults, 7.9 % worse to 13 % better, may be none" where
/// the points tell a best one and its gain is not resolved; else empty.
std::string unresolved_text(const BestPoint& best, const Effect& effect);

/// What the point is.
enum class Standing {
  kKeepDefaults,  ///< no other is better
  kBest,          ///< resolved
  kSmall,         ///< likewise, by a gain that comparisons call small
  kUnresolved,
};
Standing standing_of(const BestPoint& best, const Effect& effect);

/// "least: keep the defaults", "best", "least, too little to matter", "least, not resolved".
std::string_view name_of(Standing standing);

/// The point with the least objective over the cases; of those alike but for rounding the one next
/// to the defaults, themselves first. None when none has an objective.
std::optional<std::size_t> least_point(const ResponseTable& table, const Objective& objective,
                                       std::span<const std::size_t> cases);

/// The best values beside the defaults, or that no point is better than them.
std::string text_of(const BestPoint& best, const ResponseTable& table);

/// Error when no point has an objective, or every run diverged.
Result<BestPoint> best_point(const ResponseTable& table, const Objective& objective);

}  // namespace aims
