// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "bench/run/score_record.hpp"
#include "core/error.hpp"

namespace aims {

/// One score of one estimator over runs of the same scenario.
struct ScoreSummary {
  std::optional<double> median;  ///< over the runs that have a value
  std::optional<double> worst;   ///< largest
  std::size_t count = 0;         ///< runs that have a value
};

/// Median and worst of a score over runs.
ScoreSummary summarize(std::span<const RunRecord> runs, const std::string& estimator,
                       const std::string& key);

/// Writes summary.json, summary.csv and summary.md (the score table) into `folder`.
Result<void> write_summary(const Scenario& scenario, std::span<const RunRecord> runs,
                           const std::filesystem::path& folder);

}  // namespace aims
