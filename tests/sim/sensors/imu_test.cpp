// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/imu.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/walking.hpp"

namespace aims {
namespace {

using testing::kTimestep;

constexpr Duration kStep = 2'500'000;

/// An instrument without noise, bias or bias walk.
ImuConfig perfect() {
  ImuConfig config;
  for (InertialErrorConfig* errors : {&config.gyro, &config.accelerometer}) {
    errors->noise_density = 0.0;
    errors->bias_walk = 0.0;
    errors->turn_on_bias = 0.0;
  }
  return config;
}

std::vector<ImuSample> measure(const std::vector<TruthSample>& motion, const ImuConfig& config,
                               std::uint64_t seed = 1) {
  Imu imu(config, kStep, seed);
  std::vector<ImuSample> samples;
  for (const TruthSample& sample : motion) {
    if (auto measured = imu.sample(sample)) samples.push_back(*measured);
  }
  return samples;
}

/// A body at rest for that long.
std::vector<TruthSample> rest(double seconds, const Eigen::Quaterniond& attitude) {
  std::vector<TruthSample> motion;
  for (Time t = 0; t <= from_seconds(seconds); t += kStep) {
    TruthSample sample;
    sample.stamp = t;
    sample.T_world_body.rotation = attitude;
    motion.push_back(sample);
  }
  return motion;
}

const testing::Walk& recorded_walk() {
  static const testing::Walk walk =
      testing::walk(testing::corridor_world(4.0, 0.7, 0.0), testing::there_and_back(4.0));
  return walk;
}

/// Worst position error [m] of integrating the samples over each whole second of the walk.
double dead_reckoning_error(const std::vector<ImuSample>& samples,
                            const std::vector<TruthSample>& motion, double interval) {
  const Eigen::Vector3d gravity(0.0, 0.0, -9.81);
  double worst = 0.0;
  for (std::size_t first = 0; first + 51 < samples.size(); first += 25) {
    const TruthSample& start = motion[samples[first].stamp / kStep];
    Pose pose = start.T_world_body;
    Eigen::Vector3d velocity = start.velocity;
    for (std::size_t i = first + 1; i <= first + 50; ++i) {
      const Eigen::Vector3d turn = samples[i].angular_velocity * interval;
      const Eigen::Vector3d acceleration =
          pose.rotation * so3_exp(0.5 * turn) * samples[i].specific_force + gravity;
      pose.translation += velocity * interval + 0.5 * interval * interval * acceleration;
      velocity += acceleration * interval;
      pose.rotation = pose.rotation * so3_exp(turn);
    }
    const TruthSample& end = motion[samples[first + 50].stamp / kStep];
    worst = std::max(worst, (pose.translation - end.T_world_body.translation).norm());
  }
  return worst;
}

TEST(Imu, MeasuresGravityUpwardsAtRest) {
  const Eigen::Quaterniond tilted = so3_exp({0.1, -0.2, 0.5});
  const auto samples = measure(rest(0.1, tilted), perfect());
  ASSERT_EQ(samples.size(), 5U);
  for (const ImuSample& sample : samples) {
    EXPECT_LT((tilted * sample.specific_force - Eigen::Vector3d(0.0, 0.0, 9.81)).norm(), 1e-12);
    EXPECT_LT(sample.angular_velocity.norm(), 1e-12);
  }
  EXPECT_EQ(samples.front().stamp, 20 * kMillisecond);
}

TEST(Imu, AveragesReproduceATrotOverOneSecondWithinThreeMillimetres) {
  const auto& motion = recorded_walk().motion;
  EXPECT_LT(dead_reckoning_error(measure(motion, perfect()), motion, 0.02), 0.003);
}

TEST(Imu, PointSamplesOfATrotAreFarWorseThanAverages) {
  const auto& motion = recorded_walk().motion;
  ImuConfig config = perfect();
  config.sampling = ImuSampling::kPoint;
  EXPECT_GT(dead_reckoning_error(measure(motion, config), motion, 0.02), 0.05);
}

TEST(Imu, AveragesTurnExactlyAsFarAsTheBody) {
  const auto& motion = recorded_walk().motion;
  const auto samples = measure(motion, perfect());
  Eigen::Quaterniond attitude = motion.front().T_world_body.rotation;
  for (const ImuSample& sample : samples)
    attitude = attitude * so3_exp(0.02 * sample.angular_velocity);
  const auto& truth = motion[samples.back().stamp / kStep].T_world_body.rotation;
  EXPECT_LT(so3_log(attitude.conjugate() * truth).norm(), 1e-9);
}

TEST(Imu, NoiseHasTheStatedDensity) {
  ImuConfig config = perfect();
  config.gyro.noise_density = 2e-4;
  const auto samples = measure(rest(100.0, Eigen::Quaterniond::Identity()), config);
  double sum = 0.0;
  for (const ImuSample& sample : samples) sum += sample.angular_velocity.squaredNorm() / 3.0;
  const double sigma = std::sqrt(sum / static_cast<double>(samples.size()));
  EXPECT_NEAR(sigma, 2e-4 * std::sqrt(50.0), 0.04 * sigma);
}

TEST(Imu, SaturatesAtItsRange) {
  ImuConfig config = perfect();
  config.accelerometer.range = 5.0;
  const auto samples = measure(rest(0.02, Eigen::Quaterniond::Identity()), config);
  EXPECT_DOUBLE_EQ(samples.at(0).specific_force.z(), 5.0);
}

TEST(Imu, TurnsOnWithAnotherBiasEachRun) {
  ImuConfig config;
  const Imu one(config, kStep, 1);
  const Imu two(config, kStep, 2);
  EXPECT_NE(one.gyro_bias(), two.gyro_bias());
  config.accelerometer.turn_on_bias *= 10.0;
  EXPECT_EQ(Imu(config, kStep, 1).gyro_bias(), one.gyro_bias());
}

/// The samples of a walk with the forces of its feet.
std::vector<ImuSample> measure_walk(const ImuConfig& config, std::uint64_t seed = 1) {
  const testing::Walk& walk = recorded_walk();
  Imu imu(config, kStep, seed);
  std::vector<ImuSample> samples;
  for (std::size_t i = 0; i < walk.motion.size(); ++i) {
    if (auto measured = imu.sample(walk.motion[i], walk.states[i].foot_load)) {
      samples.push_back(*measured);
    }
  }
  return samples;
}

TEST(Imu, WithoutVibrationTheForcesOfTheFeetHaveNoEffect) {
  const auto without = measure(recorded_walk().motion, {});
  const auto with = measure_walk({});
  ASSERT_EQ(with.size(), without.size());
  for (std::size_t i = 0; i < with.size(); ++i) {
    ASSERT_EQ(with[i].angular_velocity, without[i].angular_velocity);
    ASSERT_EQ(with[i].specific_force, without[i].specific_force);
  }
}

TEST(Imu, TwoOutputsShareTheVibrationAndTheErrorsOfTheRun) {
  ImuConfig config = perfect();
  config.sampling = ImuSampling::kPoint;
  config.bandwidth = 100.0;
  config.vibration.level = 1.0;
  config.vibration.floor_rate = 0.02;
  config.vibration.floor_acceleration = 0.1;
  for (InertialErrorConfig* errors : {&config.gyro, &config.accelerometer}) {
    errors->turn_on_bias = 0.01;
    errors->scale_error = 0.01;
    errors->misalignment = 0.01;
    errors->drift = 0.01;
  }
  config.gyro.g_sensitivity = 1e-3;
  const auto slow = measure_walk(config, 5);
  config.rate = 400.0;
  const auto fast = measure_walk(config, 5);
  ASSERT_EQ(fast.size() / 8, slow.size());
  for (std::size_t i = 1; i < slow.size(); ++i) {
    const ImuSample& same = fast[8 * i + 7];
    ASSERT_EQ(same.stamp, slow[i].stamp);
    // The drift of the slower output is that of its last sample.
    ASSERT_LT((same.angular_velocity - slow[i].angular_velocity).norm(), 2e-4);
    ASSERT_LT((same.specific_force - slow[i].specific_force).norm(), 2e-4);
  }
}

TEST(Imu, TheLowPassDelaysAStepOfTheRateAsAFirstOrderFilter) {
  std::vector<TruthSample> motion = rest(0.5, Eigen::Quaterniond::Identity());
  for (std::size_t i = 1; i < motion.size(); ++i) motion[i].angular_velocity.z() = 2.0;
  ImuConfig config = perfect();
  config.rate = 400.0;
  config.sampling = ImuSampling::kPoint;
  config.bandwidth = 10.0;
  config.filter_order = 1;
  motion.insert(motion.begin(), TruthSample());
  motion.front().stamp = -kStep;
  const auto samples = measure(motion, config);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t = 0.0025 * static_cast<double>(i);
    const double expected = 2.0 * (1.0 - std::exp(-20.0 * M_PI * t));
    ASSERT_NEAR(samples[i].angular_velocity.z(), expected, 1e-9) << i;
  }
}

TEST(Imu, AveragesBehindAWideFilterAreThoseWithoutIt) {
  ImuConfig config = perfect();
  const auto plain = measure_walk(config);
  config.bandwidth = 2000.0;
  config.filter_order = 1;
  const auto filtered = measure_walk(config);
  ASSERT_EQ(filtered.size(), plain.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    ASSERT_LT((filtered[i].angular_velocity - plain[i].angular_velocity).norm(), 1e-6);
    ASSERT_LT((filtered[i].specific_force - plain[i].specific_force).norm(), 1e-6);
  }
}

TEST(Imu, RefusesARateThatDoesNotDividePhysics) {
  ImuConfig config;
  config.rate = 60.0;
  EXPECT_FALSE(validate(config, kStep));
}

}  // namespace
}  // namespace aims
