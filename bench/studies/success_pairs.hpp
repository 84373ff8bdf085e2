// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "bench/scoring/score_statistics.hpp"
#include "bench/studies/suite.hpp"

namespace aims {

/// The successes of two estimators on the valid runs that both finished, of all scenarios.
struct SuccessPair {
  std::string first;
  std::string second;
  std::array<SuccessTest, kSuccessCount> tests;  ///< in the order of `success_scores()`
};

/// Every pair of estimators with a common sequence.
std::vector<SuccessPair> success_pairs(const Suite& suite);

/// The pairs as suite.json holds them.
Json success_pairs_json(const std::vector<SuccessPair>& pairs);

}  // namespace aims
