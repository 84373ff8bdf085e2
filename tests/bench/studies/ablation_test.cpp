// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/ablation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "bench/studies/consistency_study.hpp"
#include "core/files/atomic_file.hpp"
#include "tests/bench/studies/short_walk.hpp"
#include "tests/support/estimator_settings.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using test::keep_going;
using test::options_for;
using test::short_walk;

std::vector<ScenarioFile> one_walk() { return {{"short.yaml", short_walk("short")}}; }

bool contains(const std::vector<std::string>& texts, const std::string& text) {
  return std::find(texts.begin(), texts.end(), text) != texts.end();
}

TEST(AblationSpecs, AreTheWholeAndItselfWithoutEachPartThatIsOn) {
  const auto specs = ablation_specs("aims_d", {}, {});
  ASSERT_TRUE(specs) << specs.error().message;
  EXPECT_EQ(specs->front(), "aims_d");
  for (const char* spec :
       {"no_ground_constraint=aims_d+ground_constraint.enabled=false",
        "no_leg_states=aims_d+leg_states.enabled=false",
        "no_cross_validation=aims_d+cross_validation.enabled=false",
        "no_calibration=aims_d+calibration.enabled=false", "no_legs=aims_d+legs.enabled=false"}) {
    EXPECT_TRUE(contains(*specs, spec)) << spec;
  }
  EXPECT_FALSE(contains(*specs, "with_degeneracy=aims_d+degeneracy.enabled=true"));
  EXPECT_TRUE(check_estimator_specs(*specs));
}

TEST(AblationSpecs, APartThatItsOwnSettingsNeedStays) {
  const auto specs = ablation_specs("mine=aims_d+leg_states.scale_sigma=0.2", {}, {});
  ASSERT_TRUE(specs) << specs.error().message;
  for (const std::string& spec : *specs) EXPECT_FALSE(spec.starts_with("no_leg_states=")) << spec;
  EXPECT_TRUE(contains(
      *specs, "no_robust_kernel=aims_d+leg_states.scale_sigma=0.2+robust_kernel.enabled=false"));
}

TEST(AblationSpecs, TurnOnWhatTheScenarioOrTheSpecTurnsOff) {
  const EstimatorConfigs base = test::with({}, "aims_d.ground_constraint.enabled", "false");
  const auto specs = ablation_specs("mine=aims_d+zero_velocity.enabled=false",
                                    {"ground_constraint", "zero_velocity"}, base);
  ASSERT_TRUE(specs) << specs.error().message;
  EXPECT_TRUE(contains(*specs,
                       "with_ground_constraint=aims_d+zero_velocity.enabled=false+"
                       "ground_constraint.enabled=true"));
  EXPECT_TRUE(contains(*specs,
                       "with_zero_velocity=aims_d+zero_velocity.enabled=false+"
                       "zero_velocity.enabled=true"));
}

TEST(AblationSpecs, AGroupWithoutFlagsThatHaveAnEffectIsRefused) {
  EXPECT_FALSE(ablation_specs("aims_d", {"leg_staets"}, {}));
  EXPECT_FALSE(ablation_specs("amis_d", {"leg_states"}, {}));
  EXPECT_FALSE(ablation_specs("lio", {"leg_states"}, {}));
}

/// A record whose scores are those of the labels.
RunRecord record_with(std::uint64_t seed, const std::map<std::string, double>& ate) {
  RunRecord record{seed, {{"seed", seed}, {"robot", {{"fell", false}}}}};
  for (const auto& [label, value] : ate) {
    record.scores["estimators"][label] = {{"success", true}, {"ate_yaw_m", value}};
  }
  return record;
}

TEST(Ablation, RatiosAreOfMediansAndTheirMeanOverScenariosIsGeometric) {
  Suite suite;
  for (const auto& [name, factor] : {std::pair("a", 2.0), std::pair("b", 8.0)}) {
    SuiteCase each;
    each.scenario.name = name;
    each.scenario.run = {"aims_d", "no_ground_constraint=aims_d+ground_constraint.enabled=false"};
    for (const std::uint64_t seed : {1, 2, 3}) {
      const double ate = 0.1 * static_cast<double>(seed);
      each.runs.push_back(
          record_with(seed, {{"aims_d", ate}, {"no_ground_constraint", factor * ate}}));
    }
    suite.cases.push_back(std::move(each));
  }
  const Ablation ablation = ablation_of(suite, "aims_d");
  ASSERT_EQ(ablation.effects.size(), 2U);
  EXPECT_NEAR(*ablation.effects[0].ratios[0], 1.0, 1e-12);
  EXPECT_NEAR(*ablation.effects[1].ratios[0], 4.0, 1e-12);
  EXPECT_NEAR(*ablation.effects[1].worst_ratio, 8.0, 1e-12);
  EXPECT_EQ(ablation.effects[1].worst_scenario, "b");
  EXPECT_EQ(ablation.effects[1].changes, "aims_d+ground_constraint.enabled=false");
  EXPECT_NEAR(*ablation.cases[0].rows[1].cells[0].median, 0.4, 1e-12);
  EXPECT_NEAR(*ablation.cases[0].rows[1].cells[0].ratio, 2.0, 1e-12);
  EXPECT_FALSE(ablation.effects[1].ratios[3]) << "no run has M_list";
  EXPECT_EQ(ablation.effects[1].compared, 6U);
}

TEST(Ablation, CountsSuccessesAndComparesWhatLacksAPartByThemAlone) {
  SuiteCase each;
  each.scenario.name = "a";
  each.scenario.run = {"aims_d", "no_legs=aims_d+legs.enabled=false"};
  for (const std::uint64_t seed : {1, 2}) {
    each.runs.push_back(record_with(seed, {{"aims_d", 0.1}, {"no_legs", 0.2}}));
  }
  Json& stops = each.runs[1].scores["estimators"]["no_legs"];
  stops["success"] = false;
  stops["diverged_reason"] = "ends_early";
  Suite suite;
  suite.cases.push_back(std::move(each));
  const TextTable table = case_table(ablation_of(suite, "aims_d").cases.at(0));
  const auto cell = [&](std::size_t row, const std::string& title) {
    const auto at = std::ranges::find(table.header, title) - table.header.begin();
    return at < std::ssize(table.header) ? table.rows[row][static_cast<std::size_t>(at)] : "";
  };
  EXPECT_EQ(cell(0, "ATE yaw [m]"), "0.100 (x1)");
  EXPECT_EQ(cell(1, "ATE yaw [m]"), "0.200 (x2), 1 of 2");
  EXPECT_EQ(cell(0, "within 5 %"), "2/2 (34-100 %)");
  EXPECT_EQ(cell(1, "within 5 %"), "1/2 (9-91 %)");
}

TEST(Ablation, DoesAllVariantsOnOneSequenceAndContinues) {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  const AblationOptions variants = {"aims_d", {"ground_constraint"}, {"lio"}};
  std::optional<std::string> csv;
  for (const int processes : {2, 1}) {
    std::vector<ScenarioFile> scenarios = one_walk();
    ASSERT_TRUE(set_variants(variants, scenarios));
    const auto suite = run_suite(std::move(scenarios), options_for(out, processes), keep_going);
    ASSERT_TRUE(suite) << suite.error().message;
    EXPECT_EQ(suite->run.done, processes == 2 ? 6U : 0U) << "three variants on two seeds, once";
    const Ablation ablation = ablation_of(*suite, "aims_d");
    ASSERT_EQ(ablation.cases.at(0).rows.size(), 3U);
    EXPECT_EQ(ablation.cases[0].rows[1].label, "no_ground_constraint");
    ASSERT_TRUE(write_ablation(ablation, *suite, out));
    for (const char* name : {"ablation.md", "ablation.json"}) EXPECT_TRUE(fs::exists(out / name));
    const auto text = read_file(out / "ablation.csv");
    ASSERT_TRUE(text);
    EXPECT_EQ(csv.value_or(*text), *text);
    csv = *text;
  }
}

TEST(ConsistencyStudy, KeepsASeriesPerSeedAndDoesTheJobsThatLackIt) {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  ASSERT_TRUE(run_suite(one_walk(), options_for(out), keep_going));
  SuiteOptions options = options_for(out);
  options.jobs.outputs.weak_axis = true;
  const auto suite = run_suite(one_walk(), options, keep_going);
  ASSERT_TRUE(suite) << suite.error().message;
  EXPECT_EQ(suite->run.done, 4U) << "jobs without a series are no answer";
  const auto study = consistency_study(*suite, out);
  ASSERT_TRUE(study) << study.error().message;
  ASSERT_EQ(study->size(), 2U);
  const ConsistencyCase& aims = study->at(0);
  EXPECT_EQ(aims.estimator, "aims");
  EXPECT_EQ(aims.seeds, (std::vector<std::uint64_t>{1, 2}));
  ASSERT_GE(aims.runs[0].size(), 3U);
  for (std::size_t i = 1; i < aims.runs[0].size(); ++i) {
    EXPECT_NEAR(aims.runs[0][i].time_s - aims.runs[0][i - 1].time_s, 1.0, 1e-9);
  }
  EXPECT_TRUE(aims.runs[0].back().sigma_m);
  EXPECT_GE(aims.runs[0].back().leg_bound_m, aims.runs[0].back().bound_m);
  EXPECT_FALSE(study->at(1).runs[0].empty() || study->at(1).runs[0][0].sigma_m)
      << "leg states no covariance";
  ASSERT_TRUE(write_consistency(*study, *suite, out));
  for (const char* name : {"consistency.md", "consistency.csv", "consistency.json"}) {
    EXPECT_TRUE(fs::exists(out / name)) << name;
  }
  EXPECT_EQ(run_suite(one_walk(), options, keep_going)->run.done, 0U);
}

}  // namespace
}  // namespace aims
