// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/estimator_spec.hpp"

#include <gtest/gtest.h>

#include "bench/jobs/job_id.hpp"
#include "bench/run/scenario.hpp"

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

TEST(EstimatorSpec, AnEstimatorNameIsItsOwnLabel) {
  const EstimatorSpec spec = parsed("aims_d");
  EXPECT_EQ(spec.label, "aims_d");
  EXPECT_EQ(spec.name, "aims_d");
  EXPECT_TRUE(spec.settings.empty());
}

TEST(EstimatorSpec, HoldsLabelNameAndSettingsInOrder) {
  const EstimatorSpec spec =
      parsed("no_ground=aims_d+directional.ground_constraint.enabled=false+leg.scale_sigma=0.1");
  EXPECT_EQ(spec.label, "no_ground");
  EXPECT_EQ(spec.name, "aims_d");
  ASSERT_EQ(spec.settings.size(), 2U);
  EXPECT_EQ(spec.settings[0],
            std::pair(std::string("directional.ground_constraint.enabled"), std::string("false")));
  const auto config = config_with(spec, EstimatorConfig{});
  ASSERT_TRUE(config);
  EXPECT_FALSE(config->directional.ground_constraint.enabled);
  EXPECT_EQ(config->leg.scale_sigma, 0.1);
}

TEST(EstimatorSpec, TextReadsBackAsTheSameSpec) {
  for (const std::string text :
       {"lio", "x=aims", "x=aims+degeneracy.eta=5+leg.velocity_sigma=[0.1,0.2,0.3]"}) {
    EXPECT_EQ(text_of(parsed(text)), text);
  }
  const EstimatorSpec made = parsed("aims+degeneracy.eta=5");
  EXPECT_EQ(parsed(text_of(made)).label, made.label);
  EXPECT_EQ(made.label, label_of("aims+degeneracy.eta=5"));
}

TEST(EstimatorSpec, APlusInsideANumberStartsNoSetting) {
  const auto config = config_with(parsed("x=aims+leg.max_speed=1e+1+degeneracy.eta=5"), {});
  ASSERT_TRUE(config);
  EXPECT_EQ(config->leg.max_speed, 10.0);
  EXPECT_EQ(config->degeneracy.eta, 5.0);
}

TEST(EstimatorSpec, AGeneratedLabelIsAValidFileName) {
  const std::string label = parsed("aims+leg.velocity_sigma=[0.1,0.2,0.3]").label;
  EXPECT_EQ(label.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-"), std::string::npos)
      << label;
}

TEST(EstimatorSpec, RejectsMalformedSpecsWithANearMatch) {
  expect_contains(error_of("amis"), "did you mean 'aims'");
  expect_contains(error_of("x=aims_d+directional.ground_constrain.enabled=false"),
                  "did you mean 'directional.ground_constraint.enabled'");
  expect_contains(error_of("x=aims+leg.scale_sigma=wide"), "leg.scale_sigma");
  expect_contains(error_of("aims+ground"), "key=value");
  expect_contains(error_of("../x=aims"), "label");
  expect_contains(error_of("=aims"), "label");
}

TEST(EstimatorSpec, ALabelMustNotBeAnotherEstimatorsName) {
  expect_contains(error_of("lio=aims"), "name of another estimator");
  expect_contains(error_of("aims=aims+degeneracy.eta=5"), "name of another estimator");
}

TEST(EstimatorSpec, RepeatedLabelsAreRejected) {
  const std::vector<std::string> twice = {"aims", "x=aims_d", "x=lio"};
  EXPECT_FALSE(check_estimator_specs(twice));
  const std::vector<std::string> once = {"aims", "x=aims_d", "y=lio"};
  EXPECT_TRUE(check_estimator_specs(once));
}

TEST(EstimatorSpec, CommasInsideBracketsSurviveTheCommandLine) {
  const std::vector<std::string> pieces = {"lio", "x=aims+leg.velocity_sigma=[0.1", "0.2", "0.3]",
                                           "aims"};
  const auto specs = joined_specs(pieces);
  ASSERT_EQ(specs.size(), 3U);
  EXPECT_EQ(specs[1], "x=aims+leg.velocity_sigma=[0.1,0.2,0.3]");
  const std::vector<std::string> setting = {estimators_setting(specs)};
  const auto scenario = default_scenario(setting);
  ASSERT_TRUE(scenario) << scenario.error().message;
  EXPECT_EQ(scenario->estimators, specs);
}

TEST(EstimatorSpec, TheUnitIdDependsOnTheSettingsAndNotOnTheLabel) {
  const Scenario scenario;
  const std::string plain = job_id(scenario, 1, "aims_d");
  EXPECT_EQ(job_id(scenario, 1, "full=aims_d"), plain);
  EXPECT_EQ(job_id(scenario, 1, "x=aims_d+directional.ground_constraint.enabled=true"), plain);
  const std::string without =
      job_id(scenario, 1, "x=aims_d+directional.ground_constraint.enabled=false");
  EXPECT_NE(without, plain);
  EXPECT_EQ(job_id(scenario, 1, "y=aims_d+directional.ground_constraint.enabled=false"), without);
  EXPECT_NE(job_id(scenario, 1, "y=aims+directional.ground_constraint.enabled=false"), without);
}

}  // namespace
}  // namespace aims
