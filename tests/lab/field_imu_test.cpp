// SPDX-License-Identifier: BSD-3-Clause
// The IMU of the level `field` against a trotting and a standing Unitree Go1 (body IMU at 400 Hz,
// 16 s of trot). The levels of vibration were fitted on seeds 1 to 3; 11 and 12 were looked
// at while the model was made, 13 and 14 only afterwards.
#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/scenario/scenario.hpp"
#include "lab/fidelity/imu_statistics.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/walking.hpp"

namespace aims {
namespace {

ImuConfig imu_with(const std::vector<std::string>& settings) {
  TemporaryFolder folder;
  const auto file = folder.path() / "s.yaml";
  std::ofstream(file) << "seed: 1\n";
  const auto scenario = load_scenario(file, settings);
  if (!scenario) throw std::runtime_error(scenario.error().message);
  return scenario->simulation.imu;
}

/// The IMU of that level, sampled at an instant at 400 Hz.
ImuConfig imu_of(const std::string& level) {
  ImuConfig config = imu_with({"sensors=" + level});
  config.rate = kImuStatisticsRate;
  config.sampling = ImuSampling::kPoint;
  return config;
}

/// 20 s of standing and a walk of 12 m at 0.5 m/s.
const testing::Walk& recorded_walk() {
  static const testing::Walk walk = [] {
    RouteConfig route;
    route.points = {{"a", 0.0, 0.0}, {"b", 12.0, 0.0}};
    route.speed = 0.5;
    route.stand_before = 20.0;
    return testing::walk(testing::corridor_world(12.0, 0.7, 0.0), route);
  }();
  return walk;
}

/// The samples between two times [s].
std::vector<ImuSample> samples(const ImuConfig& config, std::uint64_t seed, double from,
                               double to) {
  const testing::Walk& walk = recorded_walk();
  Imu imu(config, from_seconds(testing::kTimestep), seed);
  std::vector<ImuSample> taken;
  for (std::size_t i = 0; i < walk.motion.size(); ++i) {
    const auto sample = imu.sample(walk.motion[i], walk.states[i].foot_load);
    const double t = to_seconds(walk.motion[i].stamp);
    if (sample && t > from && t <= to) taken.push_back(*sample);
  }
  return taken;
}

std::vector<ImuStatistic> trot(const ImuConfig& config, std::uint64_t seed) {
  return trot_statistics(samples(config, seed, 22.0, 38.0)).value();
}

class FieldImu : public ::testing::TestWithParam<std::uint64_t> {};

/// The real robot also turned, which is most of its deviation about z: that row is not comparable.
TEST_P(FieldImu, TrotIsThatOfAGo1) {
  const auto statistics = trot(imu_of("field"), GetParam());
  EXPECT_EQ(statistics.size(), 33U);
  for (const ImuStatistic& each : statistics) {
    if (!each.comparable) continue;
    EXPECT_LT(each.factor(), 1.5) << each.quantity << ", " << each.axis;
  }
}

TEST_P(FieldImu, StandingVibratesAsAGo1Does) {
  const auto statistics = standing_statistics(samples(imu_of("field"), GetParam(), 3.0, 19.0));
  ASSERT_TRUE(statistics);
  for (const ImuStatistic& each : *statistics) {
    EXPECT_LT(each.factor(), 2.0) << each.quantity << ", " << each.axis;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, FieldImu, ::testing::Values(11, 12, 13, 14));

TEST(FieldImuLevels, WithoutVibrationAWalkIsFarFromAGo1) {
  int axes = 0;
  for (const ImuStatistic& each : trot(imu_of("datasheet"), 11)) {
    if (each.quantity != "gyro rms 50-100 Hz") continue;
    EXPECT_GT(each.factor(), 5.0) << each.axis;
    ++axes;
  }
  EXPECT_EQ(axes, 3);
}

/// All keys and values.
std::string text_of(ImuConfig config) {
  std::string text;
  for (const Parameter& parameter : fields_of(config).parameters()) {
    text += parameter.key + "=" + parameter.text() + "\n";
  }
  return text;
}

TEST(FieldImuLevels, TheDatasheetIsThatOfTheConsumerPart) {
  EXPECT_EQ(text_of(imu_with({"sensors=datasheet"})),
            text_of(imu_with({"sensors=ideal", "imu_grade=mems"})));
}

TEST(FieldImuLevels, TheIdealPartIsTheBuiltInOneAtEveryLevel) {
  EXPECT_EQ(text_of(imu_with({"sensors=ideal"})), text_of({}));
  EXPECT_EQ(text_of(imu_with({"sensors=datasheet", "imu_grade=ideal"})),
            text_of(imu_with({"sensors=field", "imu_grade=ideal"})));
}

}  // namespace
}  // namespace aims
