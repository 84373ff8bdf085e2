// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/summary.hpp"

#include <algorithm>

#include "bench/run/expectations.hpp"
#include "bench/scoring/json_text.hpp"
#include "bench/scoring/report.hpp"
#include "bench/scoring/score_statistics.hpp"
#include "bench/scoring/score_table.hpp"
#include "bench/scoring/tables.hpp"
#include "bench/scoring/validity.hpp"

namespace aims {
namespace {

Json summary_json(const Scenario& scenario, std::span<const RunRecord> runs) {
  Json summary = {{"schema", "aims.summary/2"}, {"scenario", scenario.name}};
  for (const RunRecord& run : runs) summary["seeds"].push_back(run.seed);
  summary["invalid"] = invalid_json(runs);
  summary["estimators"] = Json::object();
  const auto valid = std::ranges::find_if(runs, is_valid_run);
  const RunRecord& example = valid == runs.end() ? runs.front() : *valid;
  for (const auto& [estimator, unused] : example.scores["estimators"].items()) {
    for (const std::string& key : score_keys(example, estimator)) {
      const ScoreStatistics over_seeds = statistics_of(runs, estimator, key);
      summary["estimators"][estimator][key] = {{"median", json_of(over_seeds.median)},
                                               {"worst", json_of(over_seeds.worst)},
                                               {"count", over_seeds.count}};
    }
  }
  summary["expectations"] = Json::array();
  for (const ExpectationCheck& check : check_expectations(scenario, runs)) {
    summary["expectations"].push_back(check_json(check));
  }
  return summary;
}

std::string markdown_of(const Scenario& scenario, std::span<const RunRecord> runs) {
  const std::string left_out = left_out_text(runs);
  return to_markdown(score_table(runs)) + "\n" + score_legend(runs, scenario.scoring) +
         (left_out.empty() ? "" : "\n" + left_out + ".\n");
}

}  // namespace

Result<void> write_summary(const Scenario& scenario, std::span<const RunRecord> runs,
                           const std::filesystem::path& folder) {
  if (runs.empty()) return {};
  return write_report({.name = "summary",
                       .markdown = markdown_of(scenario, runs),
                       .csv = scores_csv(runs),
                       .json = summary_json(scenario, runs),
                       .latex = to_latex(score_table(runs))},
                      folder);
}

}  // namespace aims
