// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "bench/metrics/bootstrap.hpp"
#include "bench/run/score_record.hpp"
#include "bench/run/summary.hpp"
#include "bench/studies/suite.hpp"

namespace aims {

/// A score that suites are summed up by.
struct HeadlineScore {
  const char* key;
  const char* title;
  const char* unit;
  int digits;
  double floor;  ///< a change below this [unit] is of no interest
};

/// M_list over all segments, M_end, ATE and largest height error.
inline constexpr std::array<HeadlineScore, 4> kHeadlineScores = {{
    {"m_list_percent.all", "M_list", "%", 3, 0.02},
    {"m_end_m", "M_end", "m", 3, 0.01},
    {"ate_m", "ATE", "m", 3, 0.01},
    {"max_error_z_m", "max |z|", "m", 3, 0.01},
}};

/// 95 % bootstrap interval of the median of a score over the runs that have it; coarse below about
/// ten runs.
Interval median_interval(std::span<const RunRecord> runs, const std::string& estimator,
                         const std::string& key);

/// Runs in which the estimator stayed localized to the end.
std::size_t successes(std::span<const RunRecord> runs, const std::string& estimator);

/// Labels of the estimators that any case ran: names in the registry's order, then the others.
std::vector<std::string> estimators_of(const Suite& suite);

/// True for scores that depend on the machine and the moment.
bool is_timing(const std::string& score_key);

/// suite.json without the families.
Json suite_json(const Suite& suite);

}  // namespace aims
