// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "bench/tuning/analysis.hpp"
#include "bench/tuning/effect.hpp"
#include "bench/tuning/held_out.hpp"
#include "bench/tuning/objective.hpp"
#include "bench/tuning/response_summary.hpp"
#include "bench/tuning/sensitivity.hpp"

namespace aims {
namespace {

JobResult job_on(const char* end) {
  JobResult job;
  job.scores = {{"success", true}, {"ate_m", 0.2}};
  job.sequence = {{"simulated_s", 1.2}, {"robot", {{"fell", false}, {"end", end}}}};
  return job;
}

TEST(InvalidRunsOfTuning, AreNoScoreAndNoDivergence) {
  const RunScore fallen = run_score(job_on("fell"), "ate_m");
  EXPECT_FALSE(fallen.value);
  EXPECT_FALSE(fallen.diverged);
  EXPECT_EQ(fallen.invalid, "the robot fell at 1.2 s");
  EXPECT_EQ(run_score(job_on("route_done"), "ate_m").value, 0.2);
}

TEST(InvalidRunsOfTuning, AreLeftOutOfTheObjective) {
  Objective objective;
  objective.relative = false;
  const RunScore fallen = {std::nullopt, false, "the robot fell at 1.2 s"};
  const std::vector<RunScore> without = {{0.1}, {0.3}, {0.2, true}};
  const std::vector<RunScore> with = {{0.1}, fallen, {0.3}, {0.2, true}};
  EXPECT_EQ(objective_value(objective, with, {}), objective_value(objective, without, {}));
  EXPECT_FALSE(objective_value(objective, std::vector{fallen}, {}));
}

TEST(InvalidRunsOfTuning, AreCountedPerSequence) {
  const RunScore fallen = {std::nullopt, false, "the robot fell at 1.2 s"};
  ResponseTable table;
  table.cases = {{"corridor", "corridor", 3}, {"garage", "garage", 1}};
  table.runs = {{fallen, {0.1}}, {{0.1}, {0.1}}};
  EXPECT_EQ(
      left_out_lines(table),
      (std::vector<std::string>{
          "corridor seed 3: 1 of 2 runs are invalid and left out (the robot fell at 1.2 s)",
          "points are compared on the 1 of 2 sequences on which each has a valid run, without "
          "points that have one on fewer than half"}));
}

// Otherwise a point would look good by the easier seeds that it has left.
TEST(InvalidRunsOfTuning, AtOnePointTakeTheirSeedFromAllPoints) {
  const RunScore fallen = {std::nullopt, false, "the robot fell at 1.2 s"};
  ResponseTable table;
  table.ranges = {{.key = "a", .low = 0.0, .high = 1.0}};
  table.defaults = {0.5};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) table.cases.push_back({"walk", "walk", seed});
  table.points = {{0.0}, {0.5}, {1.0}};
  table.runs = {{{0.1}, {0.5}, {0.9}}, {{0.1}, {0.5}, fallen}, {fallen, fallen, fallen}};
  EXPECT_EQ(cases_of(table, ""), (std::vector<std::size_t>{0, 1}));
  table.runs[1] = {{0.1}, fallen, fallen};
  EXPECT_EQ(cases_of(table, "").size(), 3U) << "a point at which the robot keeps falling";
  EXPECT_FALSE(objective_at(table, objective_for({}, table), 1, cases_of(table, "")));
  table.runs[1] = {{0.1}, {0.5}, fallen};
  EXPECT_TRUE(effect_of(table, objective_for({}, table)).is_none());
}

// A seed whose robot fell at every point is no seed: the others are still tested.
TEST(InvalidRunsOfTuning, OfAWholeSeedLeaveTheOtherSeedsTheirTest) {
  const RunScore fallen = {std::nullopt, false, "the robot fell at 1.2 s"};
  ResponseTable table;
  table.ranges = {{.key = "a", .low = 0.0, .high = 1.0}};
  table.defaults = {0.5};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) table.cases.push_back({"walk", "walk", seed});
  for (const double a : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    table.points.push_back({a});
    table.runs.push_back({{0.1 + a}, {0.2 + a}, fallen, {0.1 + a}, {0.3 + a}});
  }
  EXPECT_EQ(seeds_of(table).size(), 4U);
  EXPECT_EQ(cases_of(table, "").size(), 4U);
  const Effect effect = effect_of(table, objective_for({}, table));
  ASSERT_TRUE(effect.p);
  EXPECT_TRUE(effect.is_resolved());
}

// Otherwise every success would count the same, and the order of the points would be chance.
TEST(FailedRunsOfTuning, WhereTheDefaultsAreLostPointsAreRelativeToTheirMedian) {
  ResponseTable table;
  table.ranges = {{.key = "a", .low = 0.0, .high = 1.0}};
  table.defaults = {0.5};
  table.cases = {{"walk", "walk", 1}, {"walk", "walk", 2}};
  table.default_runs = {{std::nullopt, true}, {std::nullopt, true}};
  table.points = {{0.0}, {0.6}, {1.0}};
  table.runs = {{{0.4}, {0.8}}, {{0.2}, {0.4}}, {{0.1}, {0.2}}};
  const auto all = cases_of(table, "");
  EXPECT_EQ(objective_at(table, Objective(), 0, all), 2.0);
  EXPECT_EQ(objective_at(table, Objective(), 1, all), 1.0);
  EXPECT_EQ(objective_at(table, Objective(), 2, all), 0.5);
}

// An optimizer that comes back to a point draws no new evidence: noise stays noise.
TEST(FailedRunsOfTuning, RepeatedPointsAreNoFurtherEvidence) {
  ResponseTable table;
  table.ranges = {{.key = "n", .low = 0.0, .high = 4.0}};
  table.defaults = {9.0};
  for (std::uint64_t seed = 1; seed <= 4; ++seed) table.cases.push_back({"walk", "walk", seed});
  const std::vector<std::vector<RunScore>> noise = {{{0.10}, {0.14}, {0.11}, {0.12}},
                                                    {{0.13}, {0.10}, {0.12}, {0.14}},
                                                    {{0.11}, {0.12}, {0.15}, {0.13}},
                                                    {{0.15}, {0.11}, {0.10}, {0.11}}};
  for (std::size_t k = 0; k < noise.size(); ++k) {
    table.points.push_back({static_cast<double>(k)});
    table.runs.push_back(noise[k]);
  }
  const auto once = effect_of(table, objective_for({}, table)).p;
  for (int repeat = 0; repeat < 30; ++repeat) {
    table.points.push_back({3.0});
    table.runs.push_back(noise[3]);
  }
  EXPECT_EQ(effect_of(table, objective_for({}, table)).p, once);
  EXPECT_EQ(other_points(table), 4U);
}

// A point at which a run is lost and another is 3 s bad is not the best because it has a ratio.
TEST(Objective, WithoutARatioWhereTheDefaultsScoreZero) {
  ResponseTable table;
  table.ranges = {{.key = "n", .low = 0.0, .high = 2.0}};
  table.defaults = {0.0};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) table.cases.push_back({"walk", "walk", seed});
  table.default_runs = {{0.0}, {0.0}, {0.0}};
  table.points = {{0.0}, {1.0}, {2.0}};
  table.runs = {table.default_runs, {{0.0}, {0.0}, {0.0}}, {{3.0, true}, {1.0}, {0.5}}};
  const Objective used = objective_for({.score = "health.degraded_s"}, table);
  EXPECT_FALSE(used.relative);
  EXPECT_NE(text_of(used).find("the defaults have 0"), std::string::npos) << text_of(used);
  const auto best = best_point(table, used);
  ASSERT_TRUE(best) << best.error().message;
  EXPECT_TRUE(best->is_default());
  EXPECT_EQ(best->defaults, 0.0);
  table.default_runs[0].value = 0.1;
  table.default_runs[1].value = 0.2;
  table.default_runs[2].value = 0.3;
  EXPECT_TRUE(objective_for({}, table).relative);
}

// A piece of the run has a small error, which is no merit.
TEST(FailedRunsOfTuning, AnEstimateThatLacksAPartOfTheRunHasNoScore) {
  JobResult job;
  job.scores = {{"success", false}, {"diverged_reason", "ends_early"}, {"ate_m", 1e-5}};
  EXPECT_FALSE(run_score(job, "ate_m").value);
  EXPECT_TRUE(run_score(job, "ate_m").diverged);
  job.scores["diverged_reason"] = "error_limit";
  EXPECT_EQ(run_score(job, "ate_m").value, 1e-5);
  job.scores["partial"] = true;
  EXPECT_FALSE(run_score(job, "ate_m").value) << "it exceeded the limit, then it stopped";
  Objective counts_scores;
  counts_scores.divergence_penalty = 0.0;
  const std::vector<RunScore> defaults = {{std::nullopt, true}};
  EXPECT_EQ(objective_value(counts_scores, std::vector<RunScore>{{0.3}}, defaults), 1.0)
      << "where the defaults stopped early a whole run is not a thousand times worse";
}

TEST(FailedRunsOfTuning, CountAsDivergedAndKeepTheirReason) {
  JobResult job;
  job.outcome = JobOutcome::kFailed;
  job.message = "the sequence could not be simulated: no floor";
  const RunScore run = run_score(job, "ate_m");
  EXPECT_TRUE(run.diverged);
  EXPECT_EQ(run.failure, job.message);
  ResponseTable table;
  table.cases = {{"corridor", "corridor", 3}};
  table.runs = {{run}, {{0.1}}};
  EXPECT_EQ(failed_lines(table),
            std::vector<std::string>{"corridor seed 3: 1 of 2 runs failed (the sequence could not "
                                     "be simulated: no floor)"});
}

// Where every run diverges the objective is the penalty everywhere: no parameter "has no effect".
TEST(FailedRunsOfTuning, OfAllPointsSayNothingAboutParameters) {
  ResponseTable table;
  table.ranges = {{.key = "a", .low = 0.0, .high = 1.0}, {.key = "b", .low = 0.0, .high = 1.0}};
  table.defaults = {0.5, 0.5};
  table.cases = {{"corridor", "corridor", 1}, {"corridor", "corridor", 2}};
  const std::vector<RunScore> lost = {{std::nullopt, true}, {std::nullopt, true}};
  table.default_runs = lost;
  for (const double a : {0.0, 0.5, 1.0}) {
    for (const double b : {0.0, 0.5, 1.0}) {
      table.points.push_back({a, b});
      table.runs.push_back(lost);
    }
  }
  EXPECT_TRUE(all_diverged(table));
  const auto none = sensitivity_of(table, Objective());
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().message, "every run diverged or failed");
  EXPECT_FALSE(best_point(table, Objective())) << "no value is better than another";
  EXPECT_EQ(verdict_of(paired_gain(table, Objective(), 0)), Verdict::kUndecided);
  table.runs.back().back() = {0.1};
  EXPECT_FALSE(all_diverged(table));
}

// The objective of diverged defaults is the penalty, which anything reduces.
TEST(FailedRunsOfTuning, OfTheDefaultsAloneLeaveNoGain) {
  ResponseTable table;
  table.ranges = {{.key = "a", .low = 0.0, .high = 1.0}};
  table.defaults = {0.5};
  std::vector<RunScore> tuned;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    table.cases.push_back({"corridor", "corridor", seed});
    table.default_runs.push_back({40.0, true});
    tuned.push_back({0.1, false});
  }
  table.points = {{1.0}};
  table.runs = {tuned};
  ASSERT_TRUE(defaults_all_diverged(table));
  const auto best = best_point(table, Objective());
  ASSERT_TRUE(best);
  EXPECT_TRUE(best->defaults_diverged);
  EXPECT_FALSE(best->gain);
  EXPECT_NE(response_markdown(table, Objective()).find(kNoGain), std::string::npos);
  const PairedGain gain = paired_gain(table, Objective(), 0);
  EXPECT_FALSE(gain.gain);
  EXPECT_EQ(verdict_of(gain), Verdict::kUseThem) << "6 of 6 saved: p = 2 / 2^6";
  EXPECT_NE(verdict_text(gain).find("0 of 6 held-out runs diverged instead of all (p = 0.031)"),
            std::string::npos)
      << verdict_text(gain);
  table.runs[0][3].diverged = true;
  EXPECT_EQ(verdict_of(paired_gain(table, Objective(), 0)), Verdict::kUndecided);
  table.default_runs[0].diverged = false;
  EXPECT_FALSE(defaults_all_diverged(table));
  EXPECT_TRUE(best_point(table, Objective())->gain);
}

// A tuning and its results read from disk have their sequences in another order.
// A sequence on which the defaults have 0 is not left out for want of a ratio.
TEST(HeldOutVerdict, CountsSequencesOnWhichTheDefaultsHaveZero) {
  ResponseTable table;
  table.ranges = {{.key = "n", .low = 0.0, .high = 2.0}};
  table.defaults = {0.0};
  for (std::uint64_t seed = 1; seed <= 6; ++seed) table.cases.push_back({"walk", "walk", seed});
  table.default_runs = {{0.0}, {0.0}, {0.0}, {1.0}, {2.0}, {3.0}};
  table.points = {{1.0}};
  table.runs = {{{1.0}, {1.0}, {1.0}, {1.0}, {2.0}, {3.0}}};
  const PairedGain gain = paired_gain(table, {.score = "health.degraded_s"}, 0);
  EXPECT_EQ(gain.sequences, 6U);
  EXPECT_EQ(gain.median_after, 1.0);
}

TEST(HeldOutVerdict, DoesNotDependOnTheOrderOfTheSequences) {
  ResponseTable table;
  table.ranges = {{.key = "a", .low = 0.0, .high = 1.0}};
  table.defaults = {0.5};
  table.points = {{1.0}};
  table.runs = {{}};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    table.cases.push_back({seed % 2 == 0 ? "corridor" : "garage", "", seed});
    table.default_runs.push_back({0.2 + 0.01 * static_cast<double>(seed), false});
    table.runs[0].push_back({0.1 + 0.02 * static_cast<double>(seed * 7 % 20), false});
  }
  const PairedGain gain = paired_gain(table, Objective(), 0);
  ASSERT_TRUE(gain.interval.low);
  EXPECT_EQ(measured_text(gain),
            "median ATE yaw 0.305 -> 0.29 m, mean change -0.015 m, diverged runs 0 -> 0 of 20");
  ResponseTable reversed = table;
  std::ranges::reverse(reversed.cases);
  std::ranges::reverse(reversed.default_runs);
  std::ranges::reverse(reversed.runs[0]);
  const PairedGain same = paired_gain(reversed, Objective(), 0);
  EXPECT_EQ(same.p, gain.p);
  EXPECT_EQ(same.interval.low, gain.interval.low);
  EXPECT_EQ(same.interval.high, gain.interval.high);
}

/// Eight seeds on which the score falls from 0.1 m by so much, a little less on each next one.
ResponseTable falls_by(double gain) {
  ResponseTable table;
  table.ranges = {{.key = "a", .low = 0.0, .high = 1.0}};
  table.defaults = {0.5};
  table.points = {{1.0}};
  table.runs = {{}};
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    table.cases.push_back({"corridor", "", seed});
    table.default_runs.push_back({0.1, false});
    table.runs[0].push_back({0.1 - gain * (1.0 - 0.01 * static_cast<double>(seed)), false});
  }
  return table;
}

// Two of eight held-out runs of the defaults crash, none with the tuned values.
TEST(HeldOutVerdict, CountsSequencesOnWhichTheDefaultsFailed) {
  ResponseTable table = falls_by(0.05);
  for (const std::size_t i : {0, 1}) table.default_runs[i] = {std::nullopt, true};
  for (const bool relative : {false, true}) {
    Objective objective;
    objective.relative = relative;
    const PairedGain gain = paired_gain(table, objective, 0);
    EXPECT_EQ(gain.seeds, 8U) << relative;
    EXPECT_EQ(gain.diverged_before, 2U) << relative;
    EXPECT_EQ(verdict_of(gain), Verdict::kUseThem) << verdict_text(gain);
  }
  for (RunScore& each : table.default_runs) each = {std::nullopt, true};
  const PairedGain all = paired_gain(table, Objective(), 0);
  EXPECT_EQ(all.seeds, 8U);
  EXPECT_EQ(verdict_of(all), Verdict::kUseThem) << verdict_text(all);
}

// Whatever the objective says, as where its penalty is small or in another unit.
TEST(HeldOutVerdict, NeverUsesValuesThatLoseRuns) {
  ResponseTable table = falls_by(0.09);
  Objective objective;
  objective.divergence_penalty = 0.0;
  EXPECT_EQ(verdict_of(paired_gain(table, objective, 0)), Verdict::kUseThem);
  table.runs[0][2].diverged = true;
  const PairedGain gain = paired_gain(table, objective, 0);
  EXPECT_EQ(verdict_of(gain), Verdict::kDoNotUse);
  EXPECT_NE(verdict_text(gain).find("more held-out runs diverge"), std::string::npos);
  EXPECT_EQ(front_verdict_of(std::vector{gain}), FrontVerdict::kWorse);
}

// The rule of `aims study compare`: 5 %, and 1 cm of an ATE.
TEST(HeldOutVerdict, NeedsAGainThatMatters) {
  const PairedGain small = paired_gain(falls_by(0.009), Objective(), 0);
  EXPECT_TRUE(is_significant(small));
  EXPECT_TRUE(is_small(small)) << "8.6 %, but less than 1 cm";
  EXPECT_EQ(verdict_of(small), Verdict::kDoNotUse);
  EXPECT_NE(verdict_text(small).find("too small to matter"), std::string::npos);
  EXPECT_NE(verdict_text(small).find("mean change -0.0086 m"), std::string::npos);
  EXPECT_EQ(front_verdict_of(std::vector{small}), FrontVerdict::kNoDifference);
  EXPECT_EQ(verdict_of(paired_gain(falls_by(0.012), Objective(), 0)), Verdict::kUseThem);
  PairedGain few = small;
  few.p = 0.06;
  EXPECT_NE(verdict_text(few).find("the gain so far is too small to matter"), std::string::npos);
  ResponseTable saved = falls_by(0.009);
  saved.default_runs[0].diverged = true;
  EXPECT_FALSE(is_small(paired_gain(saved, Objective(), 0))) << "a run less diverges";
}

TEST(HeldOutVerdict, IsUndecidedWhereTheTestCannotConfirmTheInterval) {
  PairedGain gain;
  gain.sequences = 12;
  gain.seeds = 6;
  gain.gain = 0.48;
  gain.interval.low = 0.16;
  gain.interval.high = 0.81;
  gain.p = 0.25;
  EXPECT_EQ(verdict_of(gain), Verdict::kUndecided);
  EXPECT_NE(verdict_text(gain).find("on more seeds that were never looked at"), std::string::npos);
  gain.p = 0.03;
  EXPECT_EQ(verdict_of(gain), Verdict::kUseThem);
  gain.interval.low = -0.1;
  EXPECT_EQ(verdict_of(gain), Verdict::kDoNotUse);
}

// Two scenes that are nearly copies give each seed twice: that is no more evidence.
TEST(HeldOutVerdict, CountsSeedsNotTheirScenes) {
  ResponseTable table;
  table.ranges = {{.key = "a", .low = 0.0, .high = 1.0}};
  table.defaults = {0.5};
  table.points = {{1.0}};
  table.runs = {{}};
  for (const char* scenario : {"corridor", "garage"}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      table.cases.push_back({scenario, "", seed});
      table.default_runs.push_back({0.2, false});
      table.runs[0].push_back({0.18 - 0.001 * static_cast<double>(seed), false});
    }
  }
  const PairedGain gain = paired_gain(table, Objective(), 0);
  EXPECT_EQ(gain.sequences, 6U);
  EXPECT_EQ(gain.seeds, 3U);
  EXPECT_FALSE(gain.interval.low);
  EXPECT_EQ(verdict_of(gain), Verdict::kUndecided);
}

}  // namespace
}  // namespace aims
