// SPDX-License-Identifier: BSD-3-Clause
#include "ros/node_config.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

TEST(NodeConfig, TakesSettingsOfTheRecordingAndTheEstimator) {
  NodeOptions options;
  options.overrides = {"recording.topics.imu=/imu", "estimator.imu.rate_hz=400"};
  const auto config = load_node_config(options);
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->recording.topics.imu, "/imu");
  EXPECT_EQ(config->estimator.imu.rate_hz, 400.0);
  EXPECT_EQ(config->recording.topics.truth, "none");
}

TEST(NodeConfig, RejectsWhatHasNoEffectInANode) {
  NodeOptions options;
  options.overrides = {"scoring.max_drift=1"};
  const auto config = load_node_config(options);
  ASSERT_FALSE(config);
  EXPECT_NE(config.error().message.find("scoring"), std::string::npos) << config.error().message;
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
