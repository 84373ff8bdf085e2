// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/scoring/json_text.hpp"
#include "bench/scoring/score_record.hpp"

namespace aims {

/// A scenario that could not be loaded, or an estimator that failed on one of its sequences.
struct RunFailure {
  std::string scenario;
  std::optional<std::uint64_t> seed;
  std::string estimator;  ///< its label; empty: all
  std::string message;    ///< may have several lines, e.g. a traceback
};

/// "severity_3 seed 1 aims: ..." with the whole message.
std::string text_of(const RunFailure& failure);

/// The same on one line, with the first line of the message, as an item of a Markdown list.
std::string markdown_item(const RunFailure& failure);

/// With those of one run and one message in one, whose `estimator` has all their labels.
std::vector<RunFailure> joined(std::span<const RunFailure> failures);

/// Those joined, as items of a Markdown list.
std::string markdown_list(std::span<const RunFailure> failures);

/// Scenario, seed, estimator and message of each.
Json failures_json(std::span<const RunFailure> failures);

/// A line per estimator that failed by poses that are missing or invalid, or over several runs by
/// its error: "mine on 4 of 4 seeds: gap: no poses for too long, at 10.0 s". Invalid runs
/// are left out; of a single run, the table of scores has the time of its error.
std::vector<std::string> failure_lines(std::span<const RunRecord> runs);

}  // namespace aims
