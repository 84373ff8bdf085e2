// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/score_record.hpp"

namespace aims {

/// An expectation that does not hold in one run.
struct GateFailure {
  std::string scenario;
  std::uint64_t seed = 0;
  Expectation expectation;
  std::optional<double> value;  ///< empty: the run has no such score
};

/// The expectations of the scenario that the run does not hold; those of estimators that did not
/// run do not count.
std::vector<GateFailure> failed_gates(const Scenario& scenario, const RunRecord& record);

/// One line: scenario, seed, figure, limit.
std::string text_of(const GateFailure& failure);

}  // namespace aims
