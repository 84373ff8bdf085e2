// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_config.hpp"

#include <gtest/gtest.h>

#include "tests/support/estimator_settings.hpp"

namespace aims {
namespace {

TEST(LiveConfig, TakesSettingsOfTheRecordingAndTheEstimator) {
  LiveOptions options;
  options.overrides = {"recording.topics.imu=/imu", "estimators.aims_d.imu.gravity=9.8"};
  const auto config = load_live_config(options);
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->recording.topics.imu, "/imu");
  EXPECT_EQ(test::setting(config->estimators, "aims_d.imu.gravity"), "9.8");
  EXPECT_EQ(config->recording.topics.truth, "none");
}

TEST(LiveConfig, RejectsWhatHasNoEffectInANode) {
  LiveOptions options;
  options.overrides = {"scoring.max_drift=1"};
  const auto config = load_live_config(options);
  ASSERT_FALSE(config);
  EXPECT_NE(config.error().message.find("scoring"), std::string::npos) << config.error().message;
}

TEST(LiveConfig, TakesASpecAndRejectsItsSettingsWithoutEffect) {
  LiveOptions options;
  options.estimator = "aims+ground_constraint.enabled=true";
  options.overrides = {"estimators.aims.ground_constraint.sigma_height=0.01"};
  EXPECT_TRUE(load_live_config(options));
  options.estimator = "aims";
  const auto config = load_live_config(options);
  ASSERT_FALSE(config);
  EXPECT_NE(config.error().message.find("ground_constraint.enabled is false"), std::string::npos);
}

TEST(LiveConfig, EveryRobotFileLoads) {
  LiveOptions options;
  for (const char* robot : {"simulated", "anymal", "go2", "ouster", "livox"}) {
    options.robot = robot;
    options.overrides = {"recording.topics.imu=/mine"};
    const auto config = load_live_config(options);
    ASSERT_TRUE(config) << config.error().message;
    EXPECT_FALSE(config->recording.topics.lidar.empty()) << robot;
    EXPECT_EQ(config->recording.topics.imu, "/mine") << "settings come last";
  }
  options.robot = "go3";
  const auto config = load_live_config(options);
  ASSERT_FALSE(config);
  EXPECT_NE(
      config.error().message.find("expected anymal, go2, livox, ouster, simulated or a .yaml"),
      std::string::npos)
      << config.error().message;
}

TEST(LiveConfig, RejectsAnUnknownEstimator) {
  LiveOptions options;
  options.estimator = "amis";
  const auto config = load_live_config(options);
  ASSERT_FALSE(config);
  EXPECT_NE(config.error().message.find("did you mean 'aims'"), std::string::npos);
}

TEST(LiveConfig, OneFrameForOdometryAndBodyIsAnError) {
  LiveOptions options;
  options.body_frame = options.odom_frame;
  const auto config = load_live_config(options);
  ASSERT_FALSE(config);
  EXPECT_NE(config.error().message.find("--body-frame"), std::string::npos);
}

}  // namespace
}  // namespace aims
