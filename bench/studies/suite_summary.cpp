// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/suite_summary.hpp"

#include <algorithm>

#include "bench/metrics/statistics.hpp"
#include "bench/run/code_version.hpp"
#include "estimator/estimator_spec.hpp"
#include "estimator/registry.hpp"

namespace aims {
namespace {

/// Of the resampling: one seed, so that a table can be repeated.
constexpr std::uint64_t kBootstrapSeed = 1;

Json scores_json(std::span<const RunRecord> runs, const std::string& estimator) {
  Json scores = Json::object();
  for (const std::string& key : score_keys(runs.front(), estimator)) {
    if (is_timing(key)) continue;
    const ScoreSummary summary = summarize(runs, estimator, key);
    Json score = {{"median", json_of(summary.median)},
                  {"worst", json_of(summary.worst)},
                  {"count", summary.count}};
    const bool headline = std::any_of(kHeadlineScores.begin(), kHeadlineScores.end(),
                                      [&](const HeadlineScore& each) { return each.key == key; });
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
               {"fell", Json::array()},
               {"estimators", Json::object()},
               {"gates", Json::array()}};
  for (const RunRecord& run : each.runs) {
    json["seeds"].push_back(run.seed);
    if (run.scores["robot"]["fell"] == true) json["fell"].push_back(run.seed);
  }
  for (const GateCheck& check : each.gates) json["gates"].push_back(gate_json(check));
  if (each.runs.empty()) return json;
  for (const std::string& estimator : labels_of(each.scenario.estimators)) {
    const std::size_t count = successes(each.runs, estimator);
    json["estimators"][estimator] = {
        {"runs", each.runs.size()},
        {"successes", count},
        {"success_rate", static_cast<double>(count) / static_cast<double>(each.runs.size())},
        {"scores", scores_json(each.runs, estimator)}};
  }
  return json;
}

}  // namespace

Interval median_interval(std::span<const RunRecord> runs, const std::string& estimator,
                         const std::string& key) {
  std::vector<double> values;
  for (const RunRecord& run : runs) {
    if (const auto value = find_score(run, estimator, key)) values.push_back(*value);
  }
  std::vector<double> sample(values.size());
  return bootstrap_interval(
      values.size(),
      [&](std::span<const std::size_t> drawn) {
        std::transform(drawn.begin(), drawn.end(), sample.begin(),
                       [&](std::size_t index) { return values[index]; });
        return median(sample);
      },
      kBootstrapSeed);
}

std::size_t successes(std::span<const RunRecord> runs, const std::string& estimator) {
  return static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [&](const RunRecord& run) {
        return run.scores["estimators"][estimator]["success"] == true;
      }));
}

std::vector<std::string> estimators_of(const Suite& suite) {
  std::vector<std::string> names;
  for (const EstimatorEntry& entry : estimator_registry()) {
    const bool ran = std::any_of(suite.cases.begin(), suite.cases.end(), [&](const auto& each) {
      const auto own = labels_of(each.scenario.estimators);
      return std::find(own.begin(), own.end(), entry.name) != own.end();
    });
    if (ran) names.emplace_back(entry.name);
  }
  for (const SuiteCase& each : suite.cases) {
    for (const std::string& label : labels_of(each.scenario.estimators)) {
      if (std::find(names.begin(), names.end(), label) == names.end()) names.push_back(label);
    }
  }
  return names;
}

bool is_timing(const std::string& score_key) { return score_key.starts_with("time_per_scan_ms"); }

Json suite_json(const Suite& suite) {
  Json json = {{"schema", kSuiteSchema},
               {"version", AIMS_VERSION},
               {"code", code_version()},
               {"complete", suite.complete},
               {"interval", "95 % percentile bootstrap of the median over seeds, 1000 replicates"},
               {"scenarios", Json::array()},
               {"failures", Json::array()}};
  for (const SuiteCase& each : suite.cases) json["scenarios"].push_back(case_json(each));
  for (const SuiteFailure& each : suite.failures) {
    json["failures"].push_back({{"scenario", each.scenario},
                                {"seed", each.seed ? Json(*each.seed) : Json()},
                                {"message", each.message}});
  }
  return json;
}

}  // namespace aims
