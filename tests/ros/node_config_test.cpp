// SPDX-License-Identifier: BSD-3-Clause
#include "ros/node_config.hpp"

#include <gtest/gtest.h>

#include "tests/support/estimator_settings.hpp"

namespace aims {
namespace {

TEST(NodeConfig, TakesSettingsOfTheRecordingAndTheEstimator) {
  NodeOptions options;
  options.overrides = {"recording.topics.imu=/imu", "estimators.aims_d.imu.gravity=9.8"};
  const auto config = load_node_config(options);
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->recording.topics.imu, "/imu");
  EXPECT_EQ(test::setting(config->estimators, "aims_d.imu.gravity"), "9.8");
  EXPECT_EQ(config->recording.topics.truth, "none");
}

TEST(NodeConfig, RejectsWhatHasNoEffectInANode) {
  NodeOptions options;
  options.overrides = {"scoring.max_drift=1"};
  const auto config = load_node_config(options);
  ASSERT_FALSE(config);
  EXPECT_NE(config.error().message.find("scoring"), std::string::npos) << config.error().message;
}

TEST(NodeConfig, TakesASpecAndRejectsItsSettingsWithoutEffect) {
  NodeOptions options;
  options.estimator = "aims+ground_constraint.enabled=true";
  options.overrides = {"estimators.aims.ground_constraint.sigma_height=0.01"};
  EXPECT_TRUE(load_node_config(options));
  options.estimator = "aims";
  const auto config = load_node_config(options);
  ASSERT_FALSE(config);
  EXPECT_NE(config.error().message.find("ground_constraint.enabled is false"), std::string::npos);
}

TEST(NodeConfig, RejectsAnUnknownEstimator) {
  NodeOptions options;
  options.estimator = "amis";
  const auto config = load_node_config(options);
  ASSERT_FALSE(config);
  EXPECT_NE(config.error().message.find("did you mean 'aims'"), std::string::npos);
}

}  // namespace
}  // namespace aims
