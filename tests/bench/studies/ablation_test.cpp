// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/ablation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "bench/run/weak_axis_series.hpp"
#include "bench/studies/consistency_study.hpp"
#include "core/files/atomic_file.hpp"
#include "tests/bench/run/short_walk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using test::keep_going;
using test::options_for;
using test::short_walk;

std::vector<ScenarioFile> one_walk() { return {{"short.yaml", short_walk("short")}}; }

std::size_t flags_below(const std::string& group) {
  EstimatorConfig config;
  const auto parameters = fields_of(config).parameters();
  return static_cast<std::size_t>(
      std::count_if(parameters.begin(), parameters.end(), [&](const Parameter& parameter) {
        return parameter.key.starts_with(group + ".") && parameter.expected == "true or false";
      }));
}

bool contains(const std::vector<std::string>& texts, const std::string& text) {
  return std::find(texts.begin(), texts.end(), text) != texts.end();
}

TEST(AblationSpecs, AreTheWholeAndItselfWithEachFlagTurnedOver) {
  const auto specs = ablation_specs("aims_d", {"directional"}, {});
  ASSERT_TRUE(specs) << specs.error().message;
  EXPECT_EQ(specs->size(), 1U + flags_below("directional"));
  EXPECT_EQ(specs->front(), "aims_d");
  EXPECT_TRUE(
      contains(*specs, "no_ground_constraint=aims_d+directional.ground_constraint.enabled=false"));
  EXPECT_TRUE(contains(*specs, "no_leg_states_scale=aims_d+directional.leg_states.scale=false"));
  EXPECT_TRUE(check_estimator_specs(*specs));
}

TEST(AblationSpecs, TurnOnWhatTheScenarioOrTheSpecTurnsOff) {
  EstimatorConfig base;
  base.directional.ground_constraint.enabled = false;
  const auto specs =
      ablation_specs("mine=aims_d+directional.zero_velocity.enabled=false", {"directional"}, base);
  ASSERT_TRUE(specs) << specs.error().message;
  EXPECT_TRUE(contains(*specs,
                       "with_ground_constraint=aims_d+directional.zero_velocity.enabled=false+"
                       "directional.ground_constraint.enabled=true"));
  EXPECT_TRUE(contains(*specs,
                       "with_zero_velocity=aims_d+directional.zero_velocity.enabled=false+"
                       "directional.zero_velocity.enabled=true"));
}

TEST(AblationSpecs, AGroupWithoutFlagsIsRefused) {
  EXPECT_FALSE(ablation_specs("aims_d", {"directoinal"}, {}));
  EXPECT_FALSE(ablation_specs("amis_d", {"directional"}, {}));
}

/// A record whose scores are those of the labels.
RunRecord record_with(std::uint64_t seed, const std::map<std::string, double>& ate) {
  RunRecord record{seed, {{"seed", seed}, {"robot", {{"fell", false}}}}};
  for (const auto& [label, value] : ate) {
    record.scores["estimators"][label] = {{"success", true}, {"ate_m", value}};
  }
  return record;
}

TEST(Ablation, RatiosAreOfMediansAndTheirMeanOverScenariosIsGeometric) {
  Suite suite;
  for (const auto& [name, factor] : {std::pair("a", 2.0), std::pair("b", 8.0)}) {
    SuiteCase each;
    each.scenario.name = name;
    each.scenario.estimators = {
        "aims_d", "no_ground_constraint=aims_d+directional.ground_constraint.enabled=false"};
    for (const std::uint64_t seed : {1, 2, 3}) {
      const double ate = 0.1 * static_cast<double>(seed);
      each.runs.push_back(
          record_with(seed, {{"aims_d", ate}, {"no_ground_constraint", factor * ate}}));
    }
    suite.cases.push_back(std::move(each));
  }
  const Ablation ablation = ablation_of(std::move(suite), "aims_d");
  ASSERT_EQ(ablation.worth.size(), 2U);
  EXPECT_NEAR(*ablation.worth[0].ratios[2], 1.0, 1e-12);
  EXPECT_NEAR(*ablation.worth[1].ratios[2], 4.0, 1e-12);
  EXPECT_NEAR(*ablation.worth[1].worst_ratio, 8.0, 1e-12);
  EXPECT_EQ(ablation.worth[1].worst_scenario, "b");
  EXPECT_EQ(ablation.worth[1].changes, "aims_d+directional.ground_constraint.enabled=false");
  EXPECT_NEAR(*ablation.cases[0].rows[1].cells[2].median, 0.4, 1e-12);
  EXPECT_NEAR(*ablation.cases[0].rows[1].cells[2].ratio, 2.0, 1e-12);
  EXPECT_FALSE(ablation.worth[1].ratios[0]) << "no run has M_list";
}

TEST(Ablation, RunsAllVariantsOnOneStreamAndContinues) {
  const TemporaryFolder folder;
  AblationOptions options;
  options.groups = {"directional.ground_constraint"};
  options.others = {"lio"};
  options.suite = options_for(folder.path() / "out", 2);
  const auto first = run_ablation(one_walk(), options, keep_going);
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_EQ(first->suite.runs_done, 2U) << "a seed is simulated once for all variants";
  ASSERT_EQ(first->cases.at(0).rows.size(), 3U);
  EXPECT_EQ(first->cases[0].rows[1].label, "no_ground_constraint");
  for (const char* name : {"ablation.md", "ablation.csv", "ablation.json", "suite.json"}) {
    EXPECT_TRUE(fs::exists(folder.path() / "out" / name)) << name;
  }
  const auto csv = read_file(folder.path() / "out" / "ablation.csv");
  options.suite.jobs = 1;
  const auto again = run_ablation(one_walk(), options, keep_going);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->suite.runs_done, 0U);
  EXPECT_EQ(*csv, *read_file(folder.path() / "out" / "ablation.csv"));
}

TEST(ConsistencyStudy, KeepsASeriesPerSeedAndRunsWhatLacksIt) {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  ASSERT_TRUE(run_suite(one_walk(), options_for(out), keep_going));
  const auto study = run_consistency(one_walk(), options_for(out), keep_going);
  ASSERT_TRUE(study) << study.error().message;
  EXPECT_EQ(study->suite.runs_done, 2U) << "a suite without series is no answer";
  ASSERT_EQ(study->cases.size(), 2U);
  const ConsistencyCase& aims = study->cases[0];
  EXPECT_EQ(aims.estimator, "aims");
  EXPECT_EQ(aims.seeds, (std::vector<std::uint64_t>{1, 2}));
  ASSERT_GE(aims.runs[0].size(), 3U);
  for (std::size_t i = 1; i < aims.runs[0].size(); ++i) {
    EXPECT_NEAR(aims.runs[0][i].time_s - aims.runs[0][i - 1].time_s, 1.0, 1e-9);
  }
  EXPECT_TRUE(aims.runs[0].back().sigma_m);
  EXPECT_GE(aims.runs[0].back().leg_bound_m, aims.runs[0].back().bound_m);
  EXPECT_FALSE(study->cases[1].runs[0].empty() || study->cases[1].runs[0][0].sigma_m)
      << "leg states no covariance";
  for (const char* name : {"consistency.md", "consistency.csv", "consistency.json",
                           "short-aims-consistency.png", "short-leg-consistency.svg"}) {
    EXPECT_TRUE(fs::exists(out / name)) << name;
  }
  const auto csv = read_file(out / "consistency.csv");
  const auto again = run_consistency(one_walk(), options_for(out, 2), keep_going);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->suite.runs_done, 0U);
  EXPECT_EQ(*csv, *read_file(out / "consistency.csv"));
}

}  // namespace
}  // namespace aims
