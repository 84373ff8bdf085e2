// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "bench/tuning/analysis.hpp"
#include "bench/tuning/batch_progress.hpp"
#include "bench/tuning/effect.hpp"
#include "bench/tuning/held_out.hpp"
#include "bench/tuning/range_key.hpp"
#include "bench/tuning/tune.hpp"
#include "bench/tuning/tune_summary.hpp"
#include "bench/tuning/tune_verdict.hpp"
#include "core/files/yaml_config.hpp"
#include "core/random.hpp"
#include "estimator/degeneracy/degeneracy.hpp"
#include "tests/support/estimator_settings.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

const fs::path kScenarios = AIMS_SCENARIOS;

TunePlan small_plan() {
  TunePlan plan;
  plan.params = {"degeneracy.eta=0:6", "degeneracy.kappa=log(1,100)", "degeneracy.alpha=0:0.99"};
  plan.scenarios = {"corridor", "garage"};
  plan.seeds = "1-4";
  plan.held_out.seeds = "11-18";
  plan.optimizer.generations = 12;
  plan.optimizer.population = 10;
  return plan;
}

TuneTask task_of(const TunePlan& plan) {
  auto task = tune_task(plan, kScenarios);
  EXPECT_TRUE(task) << task.error().message;
  return task.value_or(TuneTask{});
}

std::string refusal_of(const TunePlan& plan) {
  const auto task = tune_task(plan, kScenarios);
  return task ? "accepted" : task.error().message;
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

double setting(const EstimatorSpec& spec, const std::string& key, double otherwise) {
  for (const auto& [name, value] : spec.settings) {
    if (name == key) return std::atof(value.c_str());
  }
  return otherwise;
}

/// Best at eta = 1, kappa = 30; alpha plays no part; seeds scatter. With `overfit` only seeds up to
/// ten, which are tuned on, like it so.
struct Bowl {
  bool overfit = false;
  int calls = 0;
  int last_call = 1'000'000;

  Result<std::optional<SequenceScores>> operator()(std::span<const EstimatorSpec> estimators,
                                                   std::span<const ScenarioSeed> sequences) {
    if (++calls > last_call) return std::optional<SequenceScores>();
    SequenceScores scores;
    for (const EstimatorSpec& spec : estimators) {
      scores.emplace_back();
      for (const ScenarioSeed& sequence : sequences) {
        scores.back().push_back({{score(spec, sequence), false}, {time_of(spec), false}});
      }
    }
    return scores;
  }

  double score(const EstimatorSpec& spec, const ScenarioSeed& sequence) const {
    RandomStream random = rng(sequence.seed, "test." + sequence.scenario->name);
    const double eta = setting(spec, "degeneracy.eta", 3.0);
    const double kappa = setting(spec, "degeneracy.kappa", 12.6);
    const double best = overfit && sequence.seed > 10 ? 5.0 : 1.0;
    const double bowl = std::pow((eta - best) / 2.0, 2) + std::pow(std::log(kappa / 30.0), 2);
    return 0.1 * (1.0 + bowl) * std::exp(0.05 * random.normal());
  }
  static double time_of(const EstimatorSpec& spec) {
    return 5.0 - 0.5 * setting(spec, "degeneracy.eta", 3.0);
  }
};

Result<TuneResult> tuned(const TunePlan& plan, Bowl bowl = {}) {
  return tune(task_of(plan), std::ref(bowl));
}

TEST(TunePlan, IsReadFromYamlAndWrittenAsItIsRead) {
  const std::string text =
      "params: [\"degeneracy.eta=0:6\"]\nscenarios: [corridor]\nseeds: 1-2\n"
      "held_out: {seeds: 5-6, scenarios: [garage]}\n"
      "objectives:\n  - {score: m_end_m, statistic: worst, relative: false, divergence_penalty: "
      "50}\n"
      "optimizer: {algorithm: de, generations: 3, population: 6, seed: 4}\n";
  TunePlan plan;
  ASSERT_TRUE(load_config_text(text, "plan.yaml", plan));
  ASSERT_EQ(plan.objectives.size(), 1U);
  EXPECT_EQ(plan.objectives[0].statistic, ObjectiveStatistic::kWorst);
  EXPECT_EQ(plan.optimizer.kind, OptimizerKind::kDe);
  TunePlan again;
  ASSERT_TRUE(load_config_text(plan_text(plan), "again.yaml", again));
  EXPECT_EQ(plan_text(again), plan_text(plan));
}

TEST(TunePlan, FindsWalksAndUntunedValues) {
  TunePlan plan = small_plan();
  plan.held_out.scenarios = {"corridor_smooth"};
  const TuneTask task = task_of(plan);
  EXPECT_EQ(task.sequences.size(), 8U);
  EXPECT_EQ(task.held_out.size(), 24U);
  const DegeneracyConfig config;
  EXPECT_EQ(task.defaults, (std::vector<double>{config.eta, config.kappa, config.alpha}));
}

TEST(TunePlan, HoldsASequenceOutOnceHoweverOftenItIsNamed) {
  TunePlan plan = small_plan();
  plan.held_out = {{"corridor", "garage", "corridor_smooth"}, {}, "11-12"};
  EXPECT_EQ(task_of(plan).held_out.size(), 6U);
}

TEST(TunePlan, TakesTheEstimatorsKeysInFullToo) {
  TunePlan plan = small_plan();
  plan.params = {"estimators.aims.degeneracy.eta=0:6"};
  EXPECT_EQ(task_of(plan).ranges.front().key, "degeneracy.eta");
}

TEST(TunePlan, HeldOutScenariosAloneTakeTheTunedSeeds) {
  TunePlan plan = small_plan();
  plan.held_out = {{"corridor_smooth"}, {}, ""};
  const TuneTask task = task_of(plan);
  ASSERT_EQ(task.held_out.size(), 4U);
  EXPECT_EQ(task.held_out[0].scenario->name, "corridor_smooth");
}

TEST(TunePlan, RefusalSaysWhatWasExpected) {
  const auto refusal = [](const std::function<void(TunePlan&)>& change) {
    TunePlan plan = small_plan();
    change(plan);
    return refusal_of(plan);
  };
  EXPECT_TRUE(says(refusal([](TunePlan& p) { p.params.clear(); }), "expected ranges"));
  EXPECT_TRUE(says(refusal([](TunePlan& p) { p.params = {"degeneracy.eta=3:3:1"}; }), "one value"));
  EXPECT_TRUE(says(refusal([](TunePlan& p) { p.params = {"degeneracy.et=0:6"}; }), "did you mean"));
  EXPECT_TRUE(says(refusal([](TunePlan& p) { p.params = {"links.lidar.loss=0:0.5"}; }),
                   "would make the task easier"));
  EXPECT_TRUE(says(refusal([](TunePlan& p) { p.params = {"scoring.max_error_offset=0.1:5"}; }),
                   "is no key of the estimator"));
  EXPECT_TRUE(says(refusal([](TunePlan& p) { p.scenarios.clear(); }), "no scenario"));
  EXPECT_TRUE(says(refusal([](TunePlan& p) { p.scenarios = {"coridor"}; }), "corridor"));
  EXPECT_TRUE(says(refusal([](TunePlan& p) { p.seeds = "x"; }), "'x'"));
  EXPECT_TRUE(says(refusal([](TunePlan& p) { p.held_out.seeds = "4-6"; }),
                   "corridor seed 4 is also tuned on"));
  EXPECT_TRUE(says(refusal([](TunePlan& p) { p.estimator = "amis"; }), "aims"));
  EXPECT_TRUE(says(refusal([](TunePlan& p) { p.objectives.clear(); }), "objectives"));
  EXPECT_TRUE(says(refusal([](TunePlan& p) { p.objectives[0].score = ""; }), "objectives.0.score"));
  EXPECT_TRUE(says(refusal([](TunePlan& p) { p.optimizer.population = 4; }), "population"));
}

TEST(TunePlan, RefusesScoresOfWhichLessIsNotBetter) {
  for (const char* score :
       {"coverage", "success_1_percent", "drift_m.end.heading_rad", "counts.leg.lost"}) {
    TunePlan plan = small_plan();
    plan.objectives[0].score = score;
    const std::string refusal = refusal_of(plan);
    EXPECT_TRUE(says(refusal, "objectives.0.score: less of ")) << refusal;
    EXPECT_TRUE(says(refusal, score)) << refusal;
  }
}

TEST(PairedGain, NoUnitLeavesNoBlank) {
  PairedGain gain;
  gain.score = "success";
  gain.median_before = 1.0;
  gain.median_after = 1.0;
  EXPECT_TRUE(says(measured_text(gain), "median success 1 -> 1, diverged"));
}

TEST(Tune, FindsWhatIsBetterAndThatItHolds) {
  const auto result = tuned(small_plan());
  ASSERT_TRUE(result) << result.error().message;
  ASSERT_EQ(result->chosen.size(), 1U);
  const auto& best = result->tables[0].points[result->chosen[0]];
  EXPECT_NEAR(best[0], 1.0, 0.5);
  EXPECT_NEAR(std::log(best[1] / 30.0), 0.0, 0.5);
  ASSERT_EQ(result->held_out.size(), 1U);
  const auto held = best_point(result->held_out[0], result->task.plan.objectives[0]);
  ASSERT_TRUE(held);
  EXPECT_GT(*held->gain_interval.low, 0.2);
}

TEST(Tune, OverFittingShowsOnWhatIsHeldOut) {
  const auto result = tuned(small_plan(), {.overfit = true});
  ASSERT_TRUE(result);
  EXPECT_GT(*best_point(result->tables[0], Objective{})->gain, 0.3);
  EXPECT_LT(*paired_gain(result->held_out[0], Objective{}, 0).gain, 0.0);
}

TEST(Tune, SameTaskGivesTheSamePoints) {
  EXPECT_EQ(tuned(small_plan())->tables[0].points, tuned(small_plan())->tables[0].points);
}

TEST(Tune, KeepsWhatIsDoneWhenItIsInterrupted) {
  const auto result = tuned(small_plan(), {.last_call = 4});
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->complete);
  EXPECT_EQ(result->chosen.size(), 1U);
  EXPECT_TRUE(result->held_out.empty());
  const auto at_once = tuned(small_plan(), {.last_call = 0});
  ASSERT_TRUE(at_once);
  EXPECT_TRUE(at_once->chosen.empty());
}

TEST(Tune, RefusesAScoreThatNoRunHas) {
  const auto result = tune(task_of(small_plan()), [](auto estimators, auto walks) {
    const std::vector<std::vector<RunScore>> without(walks.size(), std::vector<RunScore>(1));
    return Result<std::optional<SequenceScores>>(SequenceScores(estimators.size(), without));
  });
  ASSERT_FALSE(result);
  EXPECT_TRUE(says(result.error().message, "'ate_yaw_m'"));
}

/// A score that is least with the defaults, eta = 3.
Result<std::optional<SequenceScores>> least_at_defaults(std::span<const EstimatorSpec> estimators,
                                                        std::span<const ScenarioSeed> sequences) {
  SequenceScores scores;
  for (const EstimatorSpec& spec : estimators) {
    const double eta = setting(spec, "degeneracy.eta", 3.0);
    scores.emplace_back(sequences.size(),
                        std::vector<RunScore>{{0.1 + 0.01 * std::abs(eta - 3.0), false}});
  }
  return scores;
}

TEST(Tune, KeepsTheDefaultsWhereNothingIsBetter) {
  TunePlan plan = small_plan();
  plan.params = {"degeneracy.eta=0:6"};
  const auto result = tune(task_of(plan), least_at_defaults);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_TRUE(keeps_defaults(*result));
  EXPECT_EQ(result->tables[0].points[0], result->task.defaults);
  EXPECT_TRUE(result->held_out.empty()) << "there is nothing to validate";
  EXPECT_TRUE(says(held_out_verdict(*result), "keep the defaults: none of the "));
  TuneResult one = *result;
  one.tables[0].points.resize(2);
  one.tables[0].runs.resize(2);
  EXPECT_EQ(held_out_verdict(one),
            "keep the defaults: the one other point is not better on the sequences tuned on");
  const TemporaryFolder folder;
  ASSERT_TRUE(write_tuning(*result, folder.path()));
  const std::string overlay = "@" + (folder.path() / "tuned.yaml").string();
  const auto scenario =
      load_scenario(*find_scenario("garage", kScenarios), std::vector<std::string>{overlay});
  ASSERT_TRUE(scenario) << scenario.error().message;
  EXPECT_EQ(test::number(scenario->estimators, "aims.degeneracy.eta"), DegeneracyConfig{}.eta);
}

/// A score that one key decides, the less its value the better.
auto decided_by(const std::string& key, double otherwise) {
  return [=](std::span<const EstimatorSpec> estimators, std::span<const ScenarioSeed> sequences) {
    SequenceScores scores;
    for (const EstimatorSpec& spec : estimators) {
      const double score = 0.1 + 0.01 * setting(spec, key, otherwise);
      scores.emplace_back(sequences.size(), std::vector<RunScore>{{score, false}});
    }
    return Result<std::optional<SequenceScores>>(std::move(scores));
  };
}

// alpha plays no part: points that differ in it alone are alike.
TEST(Tune, LeavesAParameterWithoutEffectAtItsDefault) {
  TunePlan plan = small_plan();
  plan.params = {"lidar.max_iterations=1:4", "degeneracy.alpha=0:0.99"};
  plan.optimizer.generations = 3;
  plan.optimizer.population = 40;
  const auto result = tune(task_of(plan), decided_by("lidar.max_iterations", 4.0));
  ASSERT_TRUE(result) << result.error().message;
  const ResponseTable& table = result->tables[0];
  ASSERT_EQ(without_effect(table), (std::vector<bool>{false, true}));
  EXPECT_EQ(table.points[result->chosen[0]], (std::vector<double>{1.0, DegeneracyConfig{}.alpha}));
  EXPECT_EQ(result->held_out[0].points[0], table.points[result->chosen[0]]);
  EXPECT_TRUE(says(verdict_lines(*result)[0], "alpha 0.9 as by default (no effect measured)"));
  EXPECT_EQ(result->generation.size(), table.points.size());
}

// All pairs that differ in alpha alone have eta 0.
TEST(Tune, DeniesNoEffectByPairsAtTheEdgeOfARange) {
  TunePlan plan = small_plan();
  plan.params = {"degeneracy.eta=0:6", "degeneracy.alpha=0:0.99"};
  const auto result = tune(task_of(plan), decided_by("degeneracy.eta", 3.0));
  ASSERT_TRUE(result) << result.error().message;
  const ResponseTable& table = result->tables[0];
  EXPECT_EQ(without_effect(table), (std::vector<bool>{false, false}));
  EXPECT_EQ(alike_in_pairs(table), (std::vector<bool>{false, true}));
  EXPECT_EQ(table.points[result->chosen[0]], (std::vector<double>{0.0, DegeneracyConfig{}.alpha}))
      << "the default of alpha was tried and is as good";
  EXPECT_TRUE(says(verdict_lines(*result)[0], "alpha 0.9 as by default"));
}

TEST(Tune, WhereEveryRunDivergesNothingIsDecided) {
  TunePlan plan = small_plan();
  plan.params = {"degeneracy.eta=0:6"};
  const auto result = tune(task_of(plan), [](auto estimators, auto sequences) {
    const std::vector<std::vector<RunScore>> lost(sequences.size(), {{40.0, true}});
    return Result<std::optional<SequenceScores>>(SequenceScores(estimators.size(), lost));
  });
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_TRUE(says(held_out_verdict(*result), "undecided: every run diverged or failed"));
  EXPECT_EQ(verdict_lines(*result)[0], "tuned values: none");
}

TEST(Tune, OfAFrontOfTheDefaultsAloneKeepsThemAndHoldsNothingOut) {
  TunePlan plan = small_plan();
  plan.params = {"degeneracy.eta=0:6"};
  plan.objectives.emplace_back().score = "m_end_m";
  plan.optimizer.population = 8;
  const auto result = tune(task_of(plan), [](auto estimators, auto sequences) {
    SequenceScores scores;
    for (const EstimatorSpec& spec : estimators) {
      const double score = 0.1 + 0.01 * std::abs(setting(spec, "degeneracy.eta", 3.0) - 3.0);
      scores.emplace_back(sequences.size(),
                          std::vector<RunScore>{{score, false}, {2.0 * score, false}});
    }
    return Result<std::optional<SequenceScores>>(std::move(scores));
  });
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_TRUE(keeps_defaults(*result));
  EXPECT_TRUE(result->held_out.empty());
  EXPECT_TRUE(says(held_out_verdict(*result), "the Pareto front has no other point"))
      << held_out_verdict(*result);
}

TEST(Tune, CountsOneGenerationAsOne) {
  TuneResult result;
  result.generation = {0, 1};
  EXPECT_TRUE(says(search_text(result), "2 different points in 1 generation of "));
}

TEST(Tune, RunsADefaultOutsideOfItsRangeAsItIsAndSaysSo) {
  TunePlan plan = small_plan();
  plan.params = {"degeneracy.eta=4:6"};
  const auto result = tune(task_of(plan), least_at_defaults);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->tables[0].points[0], std::vector<double>{3.0});
  EXPECT_EQ(result->tables[0].points[1], std::vector<double>{4.0});
  EXPECT_TRUE(keeps_defaults(*result));
  const auto lines = defaults_outside(result->task);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(says(lines[0], "the default 3 of degeneracy.eta lies outside of its range 4 to 6"));
  EXPECT_TRUE(defaults_outside(task_of(small_plan())).empty());
}

TEST(Tune, TwoObjectivesGiveAFront) {
  TunePlan plan = small_plan();
  plan.objectives.push_back({.score = "time_per_scan_ms.mean"});
  plan.optimizer.population = 12;
  plan.optimizer.generations = 8;
  const auto result = tuned(plan);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_GT(result->chosen.size(), 3U);
  const auto& points = result->tables[0].points;
  EXPECT_LT(points[result->chosen.front()][0], points[result->chosen.back()][0]);
  const TextTable front = front_table(*result);
  EXPECT_GE(front.rows.size(), result->chosen.size());
  EXPECT_EQ(front.header[3], "objective: ate_yaw_m over the defaults'");
  EXPECT_EQ(front.header.size(), 3U + 4U + 1U);
  EXPECT_NE(held_out_verdict(*result).find("front"), std::string::npos)
      << held_out_verdict(*result);
  TuneResult one = *result;  // a front of one point
  const std::size_t k = result->chosen.front() == 0 ? 1 : 0;
  one.chosen = {result->chosen[k]};
  for (ResponseTable& table : one.held_out) {
    table.points = {table.points[k]};
    table.runs = {table.runs[k]};
  }
  EXPECT_TRUE(says(held_out_verdict(one), "the one point of the front is "))
      << held_out_verdict(one);
}

TEST(FrontVerdict, IsBetterOnlyIfNoObjectiveIsWorse) {
  const auto gain = [](double value, bool sure) {
    PairedGain of;
    of.sequences = 16;
    of.seeds = 8;
    of.gain = value;
    of.interval = sure ? Interval{value - 0.01, value + 0.01} : Interval{value - 1.0, value + 1.0};
    of.p = sure ? 0.01 : 0.5;
    return of;
  };
  using Gains = std::vector<PairedGain>;
  EXPECT_EQ(front_verdict_of(Gains{gain(0.2, true), gain(-0.1, false)}), FrontVerdict::kBetter);
  EXPECT_EQ(front_verdict_of(Gains{gain(0.2, true), gain(-0.1, true)}), FrontVerdict::kMixed);
  EXPECT_EQ(front_verdict_of(Gains{gain(0.2, false), gain(-0.1, true)}), FrontVerdict::kWorse);
  EXPECT_EQ(front_verdict_of(Gains{gain(0.2, false), gain(0.1, false)}),
            FrontVerdict::kNoDifference);
  Gains few{gain(0.2, true), gain(0.1, true)};
  few.back().seeds = 3;
  EXPECT_EQ(front_verdict_of(few), FrontVerdict::kTooFew);
}

TEST(TuneReport, OverlayLoadsOnTopOfAScenario) {
  const TemporaryFolder folder;
  const auto result = tuned(small_plan());
  ASSERT_TRUE(result);
  ASSERT_TRUE(write_tuning(*result, folder.path()));
  for (const char* name : {"tune.md", "tune.csv", "tuned.yaml"}) {
    EXPECT_TRUE(fs::exists(folder.path() / name)) << name;
  }
  const auto file = find_scenario("garage", kScenarios);
  const std::string overlay = "@" + (folder.path() / "tuned.yaml").string();
  const auto scenario = load_scenario(*file, std::vector<std::string>{overlay});
  ASSERT_TRUE(scenario) << scenario.error().message;
  const auto& best = result->tables[0].points[result->chosen[0]];
  EXPECT_EQ(test::number(scenario->estimators, "aims.degeneracy.eta"), best[0]);
  EXPECT_EQ(test::number(scenario->estimators, "aims.degeneracy.kappa"), best[1]);
  EXPECT_EQ(test::number(scenario->estimators, "aims.degeneracy.alpha"), best[2]);
  EXPECT_EQ(test::number(scenario->estimators, "aims.degeneracy.w1"), DegeneracyConfig{}.w1);
  const std::string text = overlay_text(*result);
  EXPECT_TRUE(says(text, "\n# tuned values: degeneracy.eta ")) << text;
  EXPECT_TRUE(says(text, "\n# verdict: use them: ")) << text;
}

TEST(TuneReport, SaysWhichValueLiesAtAnEdgeOfItsRange) {
  const auto text = [](const std::string& range, double value) {
    const auto ranges = parse_ranges(std::vector<std::string>{range}, {});
    EXPECT_TRUE(ranges);
    return values_text(*ranges, std::vector<double>{3.0}, std::vector<double>{value});
  };
  EXPECT_EQ(text("degeneracy.eta=0:20", 1.25), "degeneracy.eta 1.25 instead of 3");
  EXPECT_EQ(text("degeneracy.eta=0:20", 3.0), "degeneracy.eta 3 as by default");
  EXPECT_EQ(
      text("degeneracy.eta=1:20", 1.13),
      "degeneracy.eta 1.13 instead of 3 (near the lower edge of its range 1 to 20: the optimum "
      "may lie outside)");
  EXPECT_EQ(
      text("degeneracy.eta=0:20", 19.9),
      "degeneracy.eta 19.9 instead of 3 (near the upper edge of its range 0 to 20: the optimum "
      "may lie outside)");
  EXPECT_EQ(
      text("degeneracy.eta=0:20", 0.13),
      "degeneracy.eta 0.13 instead of 3 (near the lower edge of its range 0 to 20: values below 0 "
      "are not allowed)");
  EXPECT_EQ(text("links.lidar.loss=0.1:0.5", 0.1),
            "links.lidar.loss 0.1 instead of 3 (at the lower edge of its range 0.1 to 0.5: the "
            "optimum may lie outside)");
}

TEST(TuneReport, WholeNumbersStayWhole) {
  TunePlan plan = small_plan();
  plan.params = {"degeneracy.eta=0:6", "lidar.max_iterations=1:9"};
  const TuneTask task = task_of(plan);
  const std::vector<double> point = {1.25, 3.7};
  EXPECT_EQ(settings_of(task, point),
            (std::vector<std::pair<std::string, std::string>>{{"degeneracy.eta", "1.25"},
                                                              {"lidar.max_iterations", "4"}}));
}

TEST(TuneReport, ConcludesNothingFromOneSequence) {
  TunePlan plan = small_plan();
  plan.scenarios = {"corridor"};
  plan.held_out.seeds = "11";
  for (const bool overfit : {false, true}) {
    const auto result = tuned(plan, {.overfit = overfit});
    ASSERT_TRUE(result);
    EXPECT_EQ(verdict_of(held_out_gain(*result)), Verdict::kUndecided);
    EXPECT_TRUE(says(held_out_verdict(*result), "nothing can be concluded from one held-out"));
  }
}

/// The scores of `run` on two scenarios and six held-out seeds, with one point besides the
/// defaults.
TuneResult held_out_result(const std::function<RunScore(std::size_t scenario, bool tuned)>& run) {
  auto result = tuned(small_plan());
  EXPECT_TRUE(result);
  ResponseTable& table = result->held_out.front();
  table.cases.clear();
  table.default_runs.clear();
  table.runs.assign(1, {});
  table.points.resize(1);
  for (std::uint64_t seed = 11; seed <= 16; ++seed) {
    for (const std::size_t scenario : {0U, 1U}) {
      const char* name = scenario == 0 ? "corridor" : "garage";
      table.cases.push_back({name, name, seed});
      table.default_runs.push_back(run(scenario, false));
      table.runs.front().push_back(run(scenario, true));
    }
  }
  return *result;
}

// One scenario that nothing saves must not hide that the other one is saved on every seed.
TEST(TuneReport, ASeedIsSavedByOneScenario) {
  const auto result = held_out_result([](std::size_t scenario, bool tuned) {
    return RunScore{.value = 1.0, .diverged = scenario == 1 || !tuned};
  });
  const std::string verdict = held_out_verdict(result);
  EXPECT_TRUE(says(verdict, "use them: 6 of 12 held-out runs diverged instead of all (p = 0.031)"))
      << verdict;
}

TEST(TuneReport, SaysWhatTheObjectiveIsWhereTheDefaultsScoreZero) {
  TuneResult result = held_out_result([](std::size_t scenario, bool tuned) {
    return RunScore{.value = tuned ? 0.1 : 0.2 * double(scenario)};
  });
  ASSERT_TRUE(result.task.plan.objectives.front().relative);
  const Json json = tune_json(result);
  EXPECT_NEAR(json["defaults"]["objectives"][0]["held_out"].get<double>(), 0.1, 1e-12);
  EXPECT_NEAR(json["chosen"][0]["objectives"][0]["held_out"].get<double>(), 0.1, 1e-12);
  const auto lines = objective_lines(result);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_TRUE(says(lines[1], "on the held-out sequences: median of ate_yaw_m, as the defaults"))
      << lines[1];
}

TEST(TuneReport, WithFewSequencesALossIsALossAndAGainIsUndecided) {
  TunePlan plan = small_plan();
  plan.scenarios = {"corridor"};
  plan.held_out.seeds = "11-13";
  const auto worse = tuned(plan, {.overfit = true});
  ASSERT_TRUE(worse);
  EXPECT_TRUE(says(held_out_verdict(*worse), "do not use them: ")) << held_out_verdict(*worse);
  EXPECT_TRUE(
      says(held_out_verdict(*worse), "3 held-out sequences of 3 seeds, too few for an interval"));
  const auto better = tuned(plan);
  ASSERT_TRUE(better);
  EXPECT_TRUE(says(held_out_verdict(*better), "undecided: ")) << held_out_verdict(*better);
}

TEST(TuneReport, AnInterruptedTuningIsNotValidated) {
  const auto result = tuned(small_plan(), {.last_call = 4});
  ASSERT_TRUE(result);
  EXPECT_TRUE(says(held_out_verdict(*result), "interrupted before the held-out sequences"));
}

TEST(TuneReport, OutcomesNameHowManySequencesTheyAreOf) {
  TunePlan plan = small_plan();
  plan.held_out = {{"garage"}, {}, "11-13"};  // garage is tuned on, too
  const auto result = tuned(plan);
  ASSERT_TRUE(result);
  const TextTable table = outcome_table(*result);
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0][0], "held out");
  EXPECT_EQ(table.rows[0][1], "6");
  EXPECT_EQ(table.rows[1][1], "8");
}

JobRun jobs_done(std::size_t count) {
  JobRun run;
  run.done = count;
  return run;
}

TEST(Tune, ProgressOfAllBatchesNeverFalls) {
  BatchProgress whole(10);
  double before = 0.0;
  const auto step = [&](std::size_t jobs, std::size_t found, std::size_t done) {
    JobProgress batch;
    batch.total = jobs - found;
    batch.done = done;
    batch.fraction = batch.total == 0 ? 1.0 : double(done) / double(batch.total);
    const JobProgress all = whole.overall(jobs, batch);
    EXPECT_GE(all.fraction, before);
    before = all.fraction;
    return all;
  };
  EXPECT_DOUBLE_EQ(step(2, 0, 1).fraction, 0.1);
  EXPECT_DOUBLE_EQ(step(2, 0, 2).fraction, 0.2);
  whole.end(2, jobs_done(2));
  EXPECT_DOUBLE_EQ(step(4, 1, 0).fraction, 0.3) << "one was found finished";
  EXPECT_EQ(step(4, 1, 3).done, 6U);
  EXPECT_TRUE(step(4, 1, 3).at_most) << "the search may converge";
  whole.end(4, jobs_done(3));
  EXPECT_EQ(step(4, 0, 0).total, 10U);
  EXPECT_FALSE(step(4, 0, 0).at_most);
  EXPECT_DOUBLE_EQ(step(4, 0, 4).fraction, 1.0);
}

// Simulating a sequence takes 10 s, a job on it 1 s.
TEST(Tune, TimeLeftIsOfWhatIsLeftOfEachKind) {
  BatchProgress whole(600);
  JobProgress batch;
  batch.total = 4;
  batch.simulation = {4, 0.0, 0.0};
  batch.evaluation = {4, 0.0, 0.0};
  EXPECT_FALSE(whole.overall(4, batch).left_s);
  batch.simulation = {4, 2.0, 20.0};
  batch.evaluation = {4, 2.0, 2.0};
  EXPECT_FALSE(whole.overall(4, batch).left_s) << "two jobs of 600 tell too little";
  batch.simulation = {4, 4.0, 40.0};
  batch.evaluation = {4, 4.0, 4.0};
  EXPECT_NEAR(whole.overall(4, batch).left_s.value(), 596.0, 1e-9);
  whole.end(4, jobs_done(4));
  JobProgress next;
  next.total = 10;
  next.evaluation = {10, 5.0, 5.0};
  next.processes = 2;
  EXPECT_NEAR(whole.overall(10, next).left_s.value(), 591.0 / 2.0, 1e-9);
}

TEST(TuneReport, SaysWhetherTheGainHolds) {
  const auto report = [](const Bowl& bowl) {
    const TemporaryFolder folder;
    EXPECT_TRUE(write_tuning(*tuned(small_plan(), bowl), folder.path()));
    std::ifstream stream(folder.path() / "tune.md");
    return std::string{std::istreambuf_iterator<char>(stream), {}};
  };
  const std::string holds = report({});
  EXPECT_TRUE(says(holds, "**verdict: use them: ")) << holds;
  EXPECT_TRUE(says(holds, "**tuned values: degeneracy.eta ")) << holds;
  EXPECT_TRUE(says(holds, " instead of 3, degeneracy.kappa ")) << holds;
  EXPECT_LT(holds.find("use them: "), holds.find("- objective")) << "the verdict leads";
  EXPECT_FALSE(says(holds, "`degeneracy.eta` does not matter")) << holds;
  const std::string overfit = report({.overfit = true});
  EXPECT_TRUE(says(overfit, "**verdict: do not use them: ")) << overfit;
  EXPECT_TRUE(says(overfit, "worse on 16 held-out sequences of 8 seeds (95 % interval")) << overfit;
}

}  // namespace
}  // namespace aims
