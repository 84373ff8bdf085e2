// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenario/score_keys.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/scenario/sequence_record.hpp"
#include "bench/scoring/score_record.hpp"

namespace aims {
namespace {

constexpr std::string_view kCounters = "counts.";

/// The segments of the scenario's route, as one that passes its points in order has them.
std::vector<SegmentDistance> route_segments(const Scenario& scenario) {
  std::vector<WaypointTime> passed;
  for (const RoutePoint& point : scenario.simulation.route.points) {
    const auto count = static_cast<Time>(passed.size());
    if (!point.name.empty()) passed.push_back({point.name, count * kSecond});
  }
  std::vector<SegmentDistance> segments;
  for (const Segment& each : segments_wanted(passed, scenario.scoring.segments)) {
    segments.emplace_back().segment = each;
  }
  return segments;
}

Scores undefined_scores(const Scenario& scenario) {
  Scores scores = undefined_scores(scenario.scoring);
  scores.segments = route_segments(scenario);
  return scores;
}

EstimatorOutcome undefined_outcome(const Scenario& scenario) {
  EstimatorOutcome outcome;
  outcome.scores = undefined_scores(scenario);
  outcome.optimized = outcome.scores;
  outcome.weak_axis = weak_axis_scores({});
  return outcome;
}

/// Error for a score that is not among those; `expected` says what they are.
Result<void> check_known(std::string_view key, const std::string& score,
                         const std::vector<std::string>& known, const std::string& expected) {
  if (std::ranges::find(known, score) != known.end()) return {};
  const std::string near = near_match(score, known);
  return failure(fmt::format("{}: no score '{}'; expected {}{}", key, score, expected,
                             near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
}

}  // namespace

std::vector<std::string> possible_score_keys(const Scenario& scenario) {
  RunRecord record;
  record.scores["estimators"]["it"] = estimator_json(undefined_outcome(scenario));
  return score_keys(record, "it");
}

std::vector<std::string> possible_run_score_keys(const Scenario& scenario) {
  const Localizability scan;
  const PosteriorBound bound;
  RunRecord record;
  record.scores =
      sequence_json(0.0, WalkOutcome(), undefined_scores(scenario), {&scan, 1}, {&bound, 1});
  return run_score_keys(record);
}

Result<void> check_score(std::string_view key, const std::string& score, const Scenario& scenario) {
  if (score.starts_with(kCounters)) return {};
  return check_known(key, score, possible_score_keys(scenario),
                     "a key of an estimator in scores.json, e.g. ate_m");
}

Result<void> check_run_score(std::string_view key, const std::string& score,
                             const Scenario& scenario) {
  const std::vector<std::string> known = possible_run_score_keys(scenario);
  return check_known(key, score, known,
                     fmt::format("a score of an estimator, which is to be named, or of the run: {}",
                                 fmt::join(known, ", ")));
}

}  // namespace aims
