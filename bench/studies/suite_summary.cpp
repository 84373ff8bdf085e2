// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/suite_summary.hpp"

#include <algorithm>

#include "bench/scoring/json_text.hpp"
#include "bench/scoring/report.hpp"
#include "bench/studies/families.hpp"
#include "bench/studies/success_pairs.hpp"
#include "core/files/atomic_file.hpp"
#include "estimator/estimator_spec.hpp"
#include "estimator/registry.hpp"

namespace aims {
namespace {

Json scores_json(std::span<const RunRecord> runs, const std::string& estimator) {
  Json scores = Json::object();
  for (const std::string& key : score_keys_in(runs, estimator)) {
    if (is_timing(key)) continue;
    const ScoreStatistics summary = statistics_of(runs, estimator, key);
    Json score = {{"median", json_of(summary.median)},
                  {"worst", json_of(summary.worst)},
                  {"count", summary.count}};
    const bool headline = std::any_of(headline_scores().begin(), headline_scores().end(),
                                      [&](const Score& each) { return each.key == key; });
    if (headline) {
      const Interval interval = median_interval(runs, estimator, key);
      score["median_low"] = json_of(interval.low);
      score["median_high"] = json_of(interval.high);
    }
    scores[key] = std::move(score);
  }
  return scores;
}

Json case_json(const SuiteCase& each) {
  Json json = {{"name", each.scenario.name},
               {"tags", each.scenario.tags},
               {"family", each.scenario.family},
               {"level", each.scenario.level},
               {"level_unit", each.scenario.level_unit},
               {"seeds", Json::array()},
               {"invalid", invalid_json(each.runs)},
               {"estimators", Json::object()},
               {"expectations", Json::array()}};
  for (const RunRecord& run : each.runs) {
    json["seeds"].push_back(run.seed);
  }
  for (const ExpectationCheck& check : each.expectations) {
    json["expectations"].push_back(check_json(check));
  }
  if (each.runs.empty()) return json;
  for (const std::string& estimator : labels_of(each.scenario.run)) {
    const SuccessRate rate = success_rate(each.runs, estimator);
    if (rate.runs == 0 && finished(each.runs, estimator) == 0) continue;
    const Interval interval = rate.interval();
    json["estimators"][estimator] = {
        {"runs", rate.runs},
        {"successes", rate.count},
        {"success_rate",
         rate.runs == 0 ? Json()
                        : Json(static_cast<double>(rate.count) / static_cast<double>(rate.runs))},
        {"success_low", json_of(interval.low)},
        {"success_high", json_of(interval.high)},
        {"successes_1_percent", success_rate(each.runs, estimator, kStrictSuccessKey).count},
        {"scores", scores_json(each.runs, estimator)}};
  }
  return json;
}

}  // namespace

std::vector<std::string> estimators_of(const Suite& suite) {
  std::vector<std::string> names;
  for (const EstimatorEntry& entry : estimator_registry()) {
    const bool ran = std::any_of(suite.cases.begin(), suite.cases.end(), [&](const auto& each) {
      const auto own = labels_of(each.scenario.run);
      return std::find(own.begin(), own.end(), entry.name) != own.end();
    });
    if (ran) names.emplace_back(entry.name);
  }
  for (const SuiteCase& each : suite.cases) {
    for (const std::string& label : labels_of(each.scenario.run)) {
      if (std::find(names.begin(), names.end(), label) == names.end()) names.push_back(label);
    }
  }
  return names;
}

Json suite_json(const Suite& suite) {
  Json json = study_head(kSuiteSchema, suite);
  json["interval"] = "95 % percentile bootstrap of the median over seeds, 1000 replicates";
  json["scenarios"] = json_array(suite.cases, case_json);
  json["failures"] = failures_json(suite.failures);
  json["settings"] = suite.settings;
  return json;
}

Json suite_document(const Suite& suite) {
  Json json = suite_json(suite);
  json["families"] = families_json(family_results(suite));
  json["success_pairs"] = success_pairs_json(success_pairs(suite));
  return json;
}

bool holds_suite(const std::filesystem::path& folder) {
  return read_json_of(folder / "suite.json", kSuiteSchema).has_value();
}

Result<void> write_suite(const Suite& suite, const std::filesystem::path& folder) {
  const std::vector<FamilyResult> families = family_results(suite);
  if (auto written = write_csv(folder / "timings.csv", timings_csv(suite)); !written) {
    return written;
  }
  return write_report({.name = "suite",
                       .markdown = suite_markdown(suite, families),
                       .csv = suite_csv(suite),
                       .json = suite_document(suite),
                       .latex = suite_latex(suite)},
                      folder);
}

}  // namespace aims
