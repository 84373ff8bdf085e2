// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/scenario/scenario.hpp"
#include "bench/scoring/score_record.hpp"
#include "bench/scoring/validity.hpp"

namespace aims {

/// An expectation held against the runs of one scenario.
struct ExpectationCheck {
  Expectation expectation;
  std::optional<double> value;       ///< of the statistic; empty: a run has no such score
  std::vector<std::uint64_t> seeds;  ///< that decide: the worst one, or all
  bool holds = false;
};

/// Every expectation of the scenario whose estimator ran, over the valid ones of `runs`, and every
/// one on the run itself, over all of them. A score that has no value in some run holds no limit,
/// whichever statistic is asked for.
std::vector<ExpectationCheck> check_expectations(const Scenario& scenario,
                                                 std::span<const RunRecord> runs);

/// The runs that are invalid although no expectation on the run itself demands what made them so.
/// One demands a fall when it holds and no robot that stays on its feet could meet it.
std::vector<InvalidRun> undemanded_runs(std::span<const RunRecord> runs,
                                        std::span<const ExpectationCheck> checks);

/// Those of the checks that do not hold.
std::vector<ExpectationCheck> failed(std::vector<ExpectationCheck> checks);

/// The check as results hold it; a limit that is none is null.
Json check_json(const ExpectationCheck& check);

/// One line: scenario, seeds, figure, limit.
std::string text_of(const Scenario& scenario, const ExpectationCheck& check);

/// The command that repeats what decided the check.
std::string reproducing_command(const Scenario& scenario, const ExpectationCheck& check);

}  // namespace aims
