// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/summary.hpp"

#include <algorithm>
#include <vector>

#include "bench/metrics/statistics.hpp"
#include "bench/run/gates.hpp"
#include "bench/run/score_table.hpp"
#include "bench/run/tables.hpp"
#include "core/files/atomic_file.hpp"

namespace aims {
namespace {

Json summary_json(const Scenario& scenario, std::span<const RunRecord> runs) {
  Json summary = {{"schema", "aims.summary/1"}, {"scenario", scenario.name}};
  for (const RunRecord& run : runs) summary["seeds"].push_back(run.seed);
  for (const auto& [estimator, unused] : runs.front().scores["estimators"].items()) {
    for (const std::string& key : score_keys(runs.front(), estimator)) {
      const ScoreSummary over_seeds = summarize(runs, estimator, key);
      summary["estimators"][estimator][key] = {{"median", json_of(over_seeds.median)},
                                               {"worst", json_of(over_seeds.worst)},
                                               {"count", over_seeds.count}};
    }
  }
  summary["gates"] = Json::array();
  for (const GateCheck& check : check_gates(scenario, runs)) {
    summary["gates"].push_back(gate_json(check));
  }
  return summary;
}

}  // namespace

ScoreSummary summarize(std::span<const RunRecord> runs, const std::string& estimator,
                       const std::string& key) {
  std::vector<double> values;
  for (const RunRecord& run : runs) {
    if (const auto value = find_score(run, estimator, key)) values.push_back(*value);
  }
  if (values.empty()) return {};
  return {median(values), *std::max_element(values.begin(), values.end()), values.size()};
}

Result<void> write_summary(const Scenario& scenario, std::span<const RunRecord> runs,
                           const std::filesystem::path& folder) {
  if (runs.empty()) return {};
  auto written = write_csv(folder / "summary.csv", scores_csv(runs));
  if (written) {
    written = write_file_atomically(folder / "summary.md", to_markdown(score_table(runs)));
  }
  if (written) {
    written =
        write_file_atomically(folder / "summary.json", summary_json(scenario, runs).dump(2) + "\n");
  }
  return written;
}

}  // namespace aims
