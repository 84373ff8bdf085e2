// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/score_keys.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/run/score_record.hpp"
#include "bench/run/sequence_record.hpp"

namespace aims {
namespace {

constexpr std::string_view kCounters = "counts.";

/// A walk along a line past the route's named points, so far apart that each segment counts.
struct ExampleWalk {
  Trajectory trajectory;
  std::vector<WaypointTime> waypoint_times;
};

ExampleWalk example_walk(const Scenario& scenario) {
  constexpr Duration kStep = 10 * kSecond;
  const double distance = 100.0 + scenario.scoring.min_segment_length;
  ExampleWalk walk;
  const auto add_pose = [&] {
    const auto count = static_cast<std::int64_t>(walk.trajectory.size());
    StampedPose& pose = walk.trajectory.emplace_back();
    pose.stamp = count * kStep;
    pose.pose.translation.x() = static_cast<double>(count) * distance;
  };
  add_pose();
  for (const RoutePoint& point : scenario.simulation.route.points) {
    add_pose();
    if (!point.name.empty()) {
      walk.waypoint_times.push_back({point.name, walk.trajectory.back().stamp});
    }
  }
  add_pose();
  return walk;
}

/// What an estimator without any error comes to: an outcome that has every score.
EstimatorOutcome example_outcome(const Scenario& scenario) {
  const ExampleWalk walk = example_walk(scenario);
  EstimatorOutcome outcome;
  outcome.scores = score(walk.trajectory, walk.trajectory, walk.waypoint_times, scenario.scoring);
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
  record.scores["estimators"]["it"] = estimator_json(example_outcome(scenario));
  return score_keys(record, "it");
}

std::vector<std::string> possible_run_score_keys(const Scenario& scenario) {
  RunLocalizability localizability;
  localizability.scans.emplace_back();
  localizability.bounds.emplace_back();
  RunRecord record;
  record.scores =
      sequence_json(0.0, WalkOutcome(), example_outcome(scenario).scores, localizability);
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
