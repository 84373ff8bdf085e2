// SPDX-License-Identifier: BSD-3-Clause
#include "harness/gates.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace aims {

std::vector<GateFailure> failed_gates(const Scenario& scenario, const RunRecord& record) {
  std::vector<GateFailure> failures;
  for (const Expectation& expectation : scenario.expect) {
    const auto& ran = scenario.estimators;
    if (std::find(ran.begin(), ran.end(), expectation.estimator) == ran.end()) continue;
    const auto value = find_score(record, expectation.estimator, expectation.score);
    if (value && *value <= expectation.max) continue;
    failures.push_back({scenario.name, record.seed, expectation, value});
  }
  return failures;
}

std::string text_of(const GateFailure& failure) {
  const std::string value = failure.value ? fmt::format("{:.4g}", *failure.value) : "no value";
  return fmt::format("{} seed {}: {} {} = {}, expected at most {:g}", failure.scenario,
                     failure.seed, failure.expectation.estimator, failure.expectation.score, value,
                     failure.expectation.max);
}

}  // namespace aims
