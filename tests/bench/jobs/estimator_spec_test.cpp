// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/estimator_spec.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/jobs/job_id.hpp"
#include "bench/scenario/scenario.hpp"
#include "core/files/yaml_config.hpp"
#include "tests/support/estimator_settings.hpp"

namespace aims {
namespace {

EstimatorSpec parsed(const std::string& text) {
  auto spec = parse_estimator_spec(text);
  EXPECT_TRUE(spec) << text << ": " << spec.error().message;
  return spec ? *spec : EstimatorSpec{};
}

std::string error_of(const std::string& text) {
  const auto spec = parse_estimator_spec(text);
  EXPECT_FALSE(spec) << text;
  return spec ? "" : spec.error().message;
}

void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text << " lacks " << part;
}

std::string text_in(EstimatorConfig& config, const char* key) {
  return fields_of(config).find(key)->text();
}

TEST(EstimatorSpec, AllIsEverySystemOnceWithoutOtherPresets) {
  const std::vector<std::string> specs =
      joined_specs(std::vector<std::string>{"all", "wide=lio+lidar.voxel=0.4"});
  EXPECT_EQ(specs.back(), "wide=lio+lidar.voxel=0.4");
  for (const char* name : {"aims", "leg", "lio", "fast_lio2", "loam", "lego_loam"}) {
    EXPECT_EQ(std::ranges::count(specs, name), 1) << name;
  }
  for (const char* name : {"fast_lio2_published", "a_loam", "all"}) {
    EXPECT_EQ(std::ranges::count(specs, name), 0) << name;
  }
}

TEST(EstimatorSpec, AnEstimatorNameIsItsOwnLabel) {
  const EstimatorSpec spec = parsed("aims_d");
  EXPECT_EQ(spec.label, "aims_d");
  EXPECT_EQ(spec.name, "aims_d");
  EXPECT_TRUE(spec.settings.empty());
}

TEST(EstimatorSpec, HoldsLabelNameAndSettingsInOrder) {
  const EstimatorSpec spec =
      parsed("no_ground=aims_d+ground_constraint.enabled=false+legs.scale_sigma=10");
  EXPECT_EQ(spec.label, "no_ground");
  EXPECT_EQ(spec.name, "aims_d");
  ASSERT_EQ(spec.settings.size(), 2U);
  EXPECT_EQ(spec.settings[0],
            std::pair(std::string("ground_constraint.enabled"), std::string("false")));
  const auto config = config_with(spec, {});
  ASSERT_TRUE(config);
  EXPECT_EQ(text_in(**config, "ground_constraint.enabled"), "false");
  EXPECT_EQ(text_in(**config, "legs.scale_sigma"), "10");
}

TEST(EstimatorSpec, TextReadsBackAsTheSameSpec) {
  for (const std::string text :
       {"lio", "x=aims", "x=aims+degeneracy.eta=5+legs.velocity_sigma=[0.1,0.2,0.3]"}) {
    EXPECT_EQ(text_of(parsed(text)), text);
  }
  const EstimatorSpec made = parsed("aims+degeneracy.eta=5");
  EXPECT_EQ(parsed(text_of(made)).label, made.label);
  EXPECT_EQ(made.label, label_of("aims+degeneracy.eta=5"));
}

TEST(EstimatorSpec, APlusInsideANumberStartsNoSetting) {
  const auto config = config_with(parsed("x=aims+legs.scale_sigma=1e+1+degeneracy.eta=5"), {});
  ASSERT_TRUE(config);
  EXPECT_EQ(text_in(**config, "legs.scale_sigma"), "10");
  EXPECT_EQ(text_in(**config, "degeneracy.eta"), "5");
}

TEST(EstimatorSpec, AGeneratedLabelIsAValidFileName) {
  const std::string label = parsed("aims+legs.velocity_sigma=[0.1,0.2,0.3]").label;
  EXPECT_EQ(label.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-"), std::string::npos)
      << label;
}

TEST(EstimatorSpec, RejectsMalformedSpecsWithANearMatch) {
  expect_contains(error_of("amis"), "did you mean 'aims'");
  expect_contains(error_of("x=aims_d+ground_constrain.enabled=false"),
                  "did you mean 'ground_constraint.enabled'");
  expect_contains(error_of("x=aims+legs.scale_sigma=wide"), "legs.scale_sigma");
  expect_contains(error_of("aims+ground"), "key=value");
  expect_contains(error_of("../x=aims"), "label");
  expect_contains(error_of("=aims"), "label");
}

TEST(EstimatorSpec, ALabelMustNotBeAnotherEstimatorsName) {
  expect_contains(error_of("lio=aims"), "name of another estimator");
  expect_contains(error_of("aims=aims+degeneracy.eta=5"), "--set estimators.aims.KEY=VALUE");
}

TEST(EstimatorSpec, RepeatedLabelsAreRejected) {
  const std::vector<std::string> twice = {"aims", "x=aims_d", "x=lio"};
  EXPECT_FALSE(check_estimator_specs(twice));
  const std::vector<std::string> once = {"aims", "x=aims_d", "y=lio"};
  EXPECT_TRUE(check_estimator_specs(once));
}

TEST(EstimatorSpec, CommasInsideBracketsSurviveTheCommandLine) {
  const std::vector<std::string> pieces = {"lio", "x=aims+legs.velocity_sigma=[0.1", "0.2", "0.3]",
                                           "aims"};
  const auto specs = joined_specs(pieces);
  ASSERT_EQ(specs.size(), 3U);
  EXPECT_EQ(specs[1], "x=aims+legs.velocity_sigma=[0.1,0.2,0.3]");
  const std::vector<std::string> setting = {run_setting(specs)};
  const auto scenario = default_scenario(setting);
  ASSERT_TRUE(scenario) << scenario.error().message;
  EXPECT_EQ(scenario->run, specs);
}

TEST(EstimatorSpec, TheUnitIdDependsOnTheSettingsAndNotOnTheLabel) {
  const Scenario scenario;
  const std::string plain = job_id(scenario, 1, "aims_d");
  EXPECT_EQ(job_id(scenario, 1, "full=aims_d"), plain);
  EXPECT_EQ(job_id(scenario, 1, "x=aims_d+ground_constraint.enabled=true"), plain);
  const std::string without = job_id(scenario, 1, "x=aims_d+ground_constraint.enabled=false");
  EXPECT_NE(without, plain);
  EXPECT_EQ(job_id(scenario, 1, "y=aims_d+ground_constraint.enabled=false"), without);
  EXPECT_NE(job_id(scenario, 1, "y=aims+ground_constraint.enabled=false"), without);
}

std::string refusal_of(std::vector<std::string> settings) {
  const auto scenario = default_scenario(settings);
  return scenario ? "" : scenario.error().message;
}

TEST(SettingsWithoutEffect, AreRefusedWithTheReason) {
  expect_contains(refusal_of({"estimators.lio.legs.scale_sigma=3"}),
                  "estimators.lio.legs.scale_sigma: has no effect: legs.enabled is false");
  expect_contains(refusal_of({"estimators.aims.ground_constraint.sigma_height=3"}),
                  "has no effect: ground_constraint.enabled is false");
  expect_contains(refusal_of({"run=[lio]", "estimators.aims.degeneracy.eta=2"}),
                  "estimators.aims.degeneracy.eta: has no effect: aims does not run");
  expect_contains(refusal_of({"run=[x=lio+legs.scale_sigma=3]"}),
                  "legs.scale_sigma: has no effect: legs.enabled is false");
}

TEST(SettingsWithoutEffect, AreFoundInTheFinalConfigurationWhateverTheOrder) {
  const std::string on = "estimators.aims.ground_constraint.enabled=true";
  const std::string height = "estimators.aims.ground_constraint.sigma_height=3";
  EXPECT_EQ(refusal_of({on, height}), "");
  EXPECT_EQ(refusal_of({height, on}), "");
  EXPECT_EQ(refusal_of({height, "run=[aims, x=aims+ground_constraint.enabled=true]"}), "");
  EXPECT_NE(refusal_of({height, on, "estimators.aims.ground_constraint.enabled=false"}), "");
}

TEST(SettingsWithoutEffect, AWildcardNeedsOneEstimatorThatRuns) {
  EXPECT_EQ(refusal_of({"estimators.*.degeneracy.eta=2", "run=[aims, lio]"}), "");
  expect_contains(refusal_of({"estimators.*.degeneracy.eta=2", "run=[tfs, lio]"}),
                  "estimators.*.degeneracy.eta: has no effect");
  expect_contains(refusal_of({"estimators.*.degeneracy.etta=2"}),
                  "did you mean 'estimators.*.degeneracy.eta'");
  const auto scenario = default_scenario(std::vector<std::string>{"estimators.*.imu.gravity=9.8"});
  ASSERT_TRUE(scenario) << scenario.error().message;
  for (const char* name : {"aims", "tfs_plus", "lio"}) {
    EXPECT_EQ(test::setting(scenario->estimators, std::string(name) + ".imu.gravity"), "9.8");
  }
}

TEST(SettingsWithoutEffect, AreNotInTheTextOfAConfigurationThatLoadsBack) {
  const std::string run = "run=[aims, x=lio+imu.gravity=9.8]";
  EXPECT_NE(refusal_of({run, "estimators.lio.legs.scale_sigma=10"}), "") << "no legs in lio";
  const auto good = default_scenario(std::vector<std::string>{run, "estimators.lio.queue.lag=0.1"});
  ASSERT_TRUE(good) << good.error().message;
  const std::string text = config_text(*good);
  EXPECT_EQ(text.find("scale_sigma: 0.05\n"), text.rfind("scale_sigma: 0.05\n"))
      << "only that of aims";
  EXPECT_EQ(text.find("tfs"), std::string::npos);
  Scenario again;
  ASSERT_TRUE(load_config_text(text, "again.yaml", again));
  EXPECT_EQ(config_text(again), text);
}

}  // namespace
}  // namespace aims
