// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/summary.hpp"

#include <algorithm>

#include "bench/run/expectations.hpp"
#include "bench/scoring/json_text.hpp"
#include "bench/scoring/report.hpp"
#include "bench/scoring/run_failure.hpp"
#include "bench/scoring/score_statistics.hpp"
#include "bench/scoring/score_table.hpp"
#include "bench/scoring/tables.hpp"
#include "bench/scoring/validity.hpp"

namespace aims {
namespace {

Json summary_json(const SeedRuns& seeds) {
  const auto& [scenario, runs, failures, complete] = seeds;
  Json summary = {{"schema", "aims.summary/2"},
                  {"scenario", scenario.name},
                  {"settings", settings_of(scenario)},
                  {"complete", complete},
                  {"failures", failures_json(failures)}};
  for (const RunRecord& run : runs) summary["seeds"].push_back(run.seed);
  summary["invalid"] = invalid_json(runs);
  summary["estimators"] = Json::object();
  for (const std::string& estimator : estimators_in(runs)) {
    summary["estimators"][estimator] = Json::object();
    for (const std::string& key : score_keys_in(runs, estimator)) {
      const ScoreStatistics over_seeds = statistics_of(runs, estimator, key);
      summary["estimators"][estimator][key] = {{"median", json_of(over_seeds.median)},
                                               {"worst", json_of(over_seeds.worst)},
                                               {"count", over_seeds.count}};
    }
  }
  summary["expectations"] = json_array(check_expectations(scenario, runs), check_json);
  return summary;
}

std::string markdown_of(const SeedRuns& seeds) {
  const auto& [scenario, runs, failures, complete] = seeds;
  std::string text;
  if (const auto settings = settings_of(scenario); !settings.empty()) {
    text += settings_markdown(settings) + "\n";
  }
  if (!complete) text += fmt::format("{}\n", kInterruptedNote);
  text += to_markdown(score_table(runs)) + "\n" + score_legend(runs, scenario.scoring);
  if (const std::string left_out = left_out_text(runs); !left_out.empty()) {
    text += "\n" + left_out + ".\n";
  }
  for (const std::string& line : failure_lines(runs)) text += "\n- No success: " + line;
  if (!failure_lines(runs).empty()) text += "\n";
  if (failures.empty()) return text;
  text += "\n## Failures\n\n";
  return text + markdown_list(failures);
}

/// The table of scores with a row per failure.
CsvTable csv_of(const SeedRuns& seeds) {
  CsvTable table = scores_csv(seeds.runs);
  for (const RunFailure& each : seeds.failures) {
    table.add(each.seed.value_or(0));
    table.add(each.estimator).add("failed").add(1.0).end_row();
  }
  return table;
}

}  // namespace

Result<void> write_summary(const SeedRuns& seeds, const std::filesystem::path& folder) {
  if (seeds.runs.empty()) return {};
  return write_report({.name = "summary",
                       .markdown = markdown_of(seeds),
                       .csv = csv_of(seeds),
                       .json = summary_json(seeds),
                       .latex = to_latex(score_table(seeds.runs))},
                      folder);
}

}  // namespace aims
