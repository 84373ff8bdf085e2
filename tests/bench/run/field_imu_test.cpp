// SPDX-License-Identifier: BSD-3-Clause
// The IMU of the level `field` against a trotting and a standing Unitree Go1 (body IMU at 400 Hz,
// 16 s of trot). The levels of vibration were fitted on seeds 1 to 3; 11 and 12 were looked
// at while the model was made, 13 and 14 only afterwards.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/metrics/power_spectrum.hpp"
#include "bench/metrics/statistics.hpp"
#include "bench/run/scenario.hpp"
#include "tests/sim/robot/walking.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

const std::vector<FrequencyBand> kBands = {{0.5, 5.0},   {5.0, 12.5},   {12.5, 25.0},
                                           {25.0, 50.0}, {50.0, 100.0}, {100.0, 200.0}};

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
  config.rate = 400.0;
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

/// Samples per axis between two times [s]: x, y, z of the specific force, then of the rate.
std::array<std::vector<double>, 6> samples(const ImuConfig& config, std::uint64_t seed, double from,
                                           double to) {
  const testing::Walk& walk = recorded_walk();
  Imu imu(config, from_seconds(testing::kTimestep), seed);
  std::array<std::vector<double>, 6> series;
  for (std::size_t i = 0; i < walk.motion.size(); ++i) {
    const auto sample = imu.sample(walk.motion[i], walk.states[i].foot_load);
    const double t = to_seconds(walk.motion[i].stamp);
    if (!sample || t <= from || t > to) continue;
    for (int axis = 0; axis < 3; ++axis) {
      series[axis].push_back(sample->specific_force[axis]);
      series[axis + 3].push_back(sample->angular_velocity[axis]);
    }
  }
  return series;
}

struct Spread {
  double deviation = 0.0;
  double largest = 0.0;
};

Spread spread(const std::vector<double>& series) {
  const double middle = *mean(series);
  Spread result;
  for (const double value : series) {
    result.deviation += (value - middle) * (value - middle) / static_cast<double>(series.size());
    result.largest = std::max(result.largest, std::abs(value - middle));
  }
  result.deviation = std::sqrt(result.deviation);
  return result;
}

void expect_within(double factor, double value, double real, const std::string& what) {
  EXPECT_GT(value, real / factor) << what;
  EXPECT_LT(value, real * factor) << what;
}

class FieldImu : public ::testing::TestWithParam<int> {
 protected:
  std::array<std::vector<double>, 6> trot() const {
    return samples(imu_of("field"), static_cast<std::uint64_t>(GetParam()), 22.0, 38.0);
  }
};

TEST_P(FieldImu, AccelerometerOfATrotIsThatOfAGo1) {
  const auto series = trot();
  const std::array<double, 3> deviation = {2.9, 2.3, 4.4};
  const std::array<double, 3> largest = {19.0, 14.0, 23.0};
  const std::array<double, 3> difference = {2.7, 2.1, 3.4};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    const Spread walked = spread(series[axis]);
    expect_within(1.5, walked.deviation, deviation[axis], "deviation " + name);
    expect_within(1.5, walked.largest, largest[axis], "largest " + name);
    expect_within(1.5, *sample_minus_mean_rms(series[axis], 8), difference[axis],
                  "point minus mean over 20 ms " + name);
  }
  const std::array<double, 6> vertical = {2.0, 1.5, 1.8, 1.5, 2.2, 1.6};
  const auto rms = *band_rms(series[2], 400.0, kBands);
  for (std::size_t i = 0; i < kBands.size(); ++i) {
    expect_within(1.5, rms[i], vertical[i], "z, band " + std::to_string(i));
  }
}

/// The real robot also turned, which is most of its deviation about z: that row is left out.
TEST_P(FieldImu, GyroOfATrotIsThatOfAGo1) {
  const auto series = trot();
  const std::array<std::array<double, 4>, 3> real = {
      {{0.16, 0.076, 0.082, 0.084}, {0.13, 0.085, 0.050, 0.038}, {0.036, 0.043, 0.037, 0.041}}};
  const std::array<double, 3> difference = {0.24, 0.23, 0.09};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    const auto rms = *band_rms(series[axis + 3], 400.0, kBands);
    for (std::size_t i = 0; i < 4; ++i) {
      expect_within(1.5, rms[i + 2], real[axis][i], name + ", band " + std::to_string(i + 2));
    }
    expect_within(1.5, *sample_minus_mean_rms(series[axis + 3], 8), difference[axis],
                  "point minus mean over 20 ms " + name);
  }
  expect_within(1.5, spread(series[3]).deviation, 0.41, "deviation x");
  expect_within(1.5, spread(series[4]).deviation, 0.57, "deviation y");
}

TEST_P(FieldImu, StandingVibratesAsAGo1Does) {
  const auto series = samples(imu_of("field"), static_cast<std::uint64_t>(GetParam()), 3.0, 19.0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double force = spread(series[axis]).deviation;
    EXPECT_GT(force, 0.08 / 2.0);
    EXPECT_LT(force, 0.17 * 2.0);
    const double rate = spread(series[axis + 3]).deviation;
    EXPECT_GT(rate, 0.010 / 2.0);
    EXPECT_LT(rate, 0.042 * 2.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, FieldImu, ::testing::Values(11, 12, 13, 14));

TEST(FieldImuLevels, WithoutVibrationAWalkIsFarFromAGo1) {
  const auto series = samples(imu_of("datasheet"), 11, 22.0, 38.0);
  EXPECT_LT(band_rms(series[3], 400.0, kBands)->at(2), 0.16 / 5.0);
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
