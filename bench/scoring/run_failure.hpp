// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "bench/scoring/json_text.hpp"

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

}  // namespace aims
