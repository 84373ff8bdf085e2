// SPDX-License-Identifier: BSD-3-Clause
// The levels of the sensors' realism, `sensors:` in a scenario.
#include "sim/sensors/sensor_level.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "bench/scenario/scenario.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

class SensorLevels : public ::testing::Test {
 protected:
  Result<Scenario> load(const char* yaml, const std::vector<std::string>& settings = {}) const {
    std::ofstream(folder_.path() / "s.yaml") << yaml;
    return load_scenario(folder_.path() / "s.yaml", settings);
  }
  TemporaryFolder folder_;
};

TEST_F(SensorLevels, FieldIsTheDefaultAndIdealHasNoErrorOfCalibration) {
  const auto field = load("seed: 1");
  ASSERT_TRUE(field) << field.error().message;
  EXPECT_EQ(field->sensors, SensorLevel::kField);
  EXPECT_GT(field->simulation.calibration.rotation_sigma_deg, 0.0);
  EXPECT_GT(field->simulation.links.lidar.clock_offset_sigma, 0.0);
  EXPECT_EQ(field->simulation.links.leg_odometry.loss, 0.05) << "the other keys keep their values";
  const auto ideal = load("sensors: ideal");
  ASSERT_TRUE(ideal) << ideal.error().message;
  EXPECT_EQ(ideal->simulation.calibration.rotation_sigma_deg, 0.0);
}

TEST_F(SensorLevels, IdealIsTheBuiltInSimulation) {
  Scenario built_in;
  built_in.sensors = SensorLevel::kIdeal;
  built_in.name = "s";
  const auto ideal = load("sensors: ideal");
  ASSERT_TRUE(ideal) << ideal.error().message;
  EXPECT_EQ(config_text(*ideal), config_text(built_in));
}

TEST_F(SensorLevels, LieBelowTheKeysOfTheScenarioAndTheSettings) {
  const char* yaml = "{sensors: field, calibration: {rotation_sigma_deg: 1.5}}";
  const auto scenario = load(yaml);
  ASSERT_TRUE(scenario) << scenario.error().message;
  EXPECT_EQ(scenario->simulation.calibration.rotation_sigma_deg, 1.5);
  EXPECT_GT(scenario->simulation.calibration.translation_sigma, 0.0);
  const auto set = load(yaml, {"sensors=ideal", "calibration.translation_sigma=0.02"});
  ASSERT_TRUE(set) << set.error().message;
  EXPECT_EQ(set->simulation.calibration.rotation_sigma_deg, 1.5);
  EXPECT_EQ(set->simulation.calibration.translation_sigma, 0.02);
  EXPECT_EQ(set->simulation.links.lidar.clock_offset_sigma, 0.0);
}

TEST_F(SensorLevels, EveryPresetLoadsAndAStoredConfigurationRepeatsIt) {
  for (const char* level : {"ideal", "datasheet", "field"}) {
    for (const char* grade : {"of_level", "ideal", "mems", "industrial"}) {
      const std::vector<std::string> settings = {std::string("sensors=") + level,
                                                 std::string("imu_grade=") + grade};
      const auto scenario = load("seed: 2", settings);
      ASSERT_TRUE(scenario) << scenario.error().message;
      const std::string text = effective_config(*scenario, 2);
      const auto again = load(text.c_str());
      ASSERT_TRUE(again) << again.error().message;
      EXPECT_EQ(effective_config(*again, 2), text);
    }
  }
}

TEST_F(SensorLevels, HoldOnlyTheirOwnExpectations) {
  const char* yaml =
      "expect:\n"
      "  - {estimator: aims, score: ate_m, max: 0.1, sensors: ideal}\n"
      "  - {estimator: aims, score: ate_m, max: 0.5, sensors: field}\n"
      "  - {estimator: aims, score: success, min: 1}\n";
  const auto field = load(yaml);
  ASSERT_TRUE(field) << field.error().message;
  ASSERT_EQ(field->expect.size(), 2U);
  EXPECT_EQ(field->expect[0].max, 0.5);
  const auto ideal = load(yaml, {"sensors=ideal"});
  ASSERT_EQ(ideal->expect.size(), 2U);
  EXPECT_EQ(ideal->expect[0].max, 0.1);
  const auto unknown = load("expect: [{estimator: aims, score: ate_m, max: 1, sensors: real}]");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("expected ideal, datasheet or field"), std::string::npos);
}

}  // namespace
}  // namespace aims
