// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/push.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "sim/simulation.hpp"

namespace aims {
namespace {

constexpr Duration kStep = kMillisecond * 5 / 2;

PushConfig some_pushes() {
  return {.count = 8, .force = 30.0, .duration = 0.2, .start = 1.0, .end = 9.0};
}

/// Time [s] of the begin of each push and how long it lasts [s], told by its force alone.
std::vector<std::pair<double, double>> pushes_of(const Pushes& pushes, double force) {
  std::vector<std::pair<double, double>> found;
  bool before = false;
  for (Time t = 0; t < 12 * kSecond; t += kStep) {
    const Eigen::Vector3d now = pushes.force_at(t);
    EXPECT_EQ(now.z(), 0.0);
    const bool pushed = !now.isZero();
    EXPECT_NEAR(now.norm(), pushed ? force : 0.0, 1e-9);
    if (pushed && !before) found.emplace_back(to_seconds(t), 0.0);
    if (pushed) found.back().second += to_seconds(kStep);
    before = pushed;
  }
  return found;
}

TEST(Pushes, ComeOncePerPartOfTheIntervalWithTheConfiguredDuration) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto found = pushes_of(Pushes(some_pushes(), seed), 30.0);
    ASSERT_EQ(found.size(), 8U) << "seed " << seed;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double part = 1.0 + static_cast<double>(i);
      EXPECT_GE(found[i].first, part);
      EXPECT_LE(found[i].first + found[i].second, part + 1.0 + 1e-9);
      EXPECT_NEAR(found[i].second, 0.2, 0.0026);
    }
  }
}

TEST(Pushes, ComeFromAllSidesAndDifferBetweenSeeds) {
  std::array<int, 4> quarters{};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Pushes pushes(some_pushes(), seed);
    for (const auto& [start, length] : pushes_of(pushes, 30.0)) {
      const Eigen::Vector3d force = pushes.force_at(from_seconds(start));
      ++quarters[(force.x() > 0.0 ? 1 : 0) + (force.y() > 0.0 ? 2 : 0)];
    }
  }
  for (const int each : quarters) EXPECT_GT(each, 20);  // 40 of 160 are expected
  EXPECT_EQ(pushes_of(Pushes(some_pushes(), 3), 30.0), pushes_of(Pushes(some_pushes(), 3), 30.0));
  EXPECT_NE(pushes_of(Pushes(some_pushes(), 3), 30.0), pushes_of(Pushes(some_pushes(), 4), 30.0));
}

TEST(Pushes, AreNoneByDefaultAndMustFitIntoTheirTime) {
  EXPECT_TRUE(pushes_of(Pushes(PushConfig{}, 1), 0.0).empty());
  EXPECT_TRUE(validate(PushConfig{}));
  PushConfig tight = some_pushes();
  tight.duration = 1.0;
  EXPECT_TRUE(validate(tight)) << "one push after another";
  tight.count = 9;
  const auto refused = validate(tight);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("push.end: expected at least 10 s"), std::string::npos)
      << refused.error().message;
}

/// Stands for five seconds, then takes two steps; the LiDAR is next to nothing.
SimulationConfig standing_robot() {
  SimulationConfig config;
  config.scene.corridor.length = 10.0;
  config.route.points = {{"a", 0.0, 0.0}, {"b", 0.5, 0.0}};
  config.route.stand_after = 0.2;
  config.lidar.columns = 16;
  return config;
}

struct Motion {
  Truth truth;
  std::vector<ImuSample> imu;
};

Motion simulate(const SimulationConfig& config, std::uint64_t seed) {
  Simulation simulation = Simulation::create(config, seed).value();
  Motion motion;
  std::vector<Delivery> deliveries;
  while (simulation.advance(kSecond, deliveries)) {
  }
  for (const Delivery& each : deliveries) {
    if (const auto* sample = std::get_if<ImuSample>(&each.measurement)) {
      motion.imu.push_back(*sample);
    }
  }
  motion.truth = simulation.truth();
  return motion;
}

/// Largest speed over the ground before `until` [s].
double largest_speed(const Truth& truth, double until) {
  double largest = 0.0;
  for (const TruthSample& sample : truth.samples) {
    if (to_seconds(sample.stamp) < until) {
      largest = std::max(largest, sample.velocity.head<2>().norm());
    }
  }
  return largest;
}

TEST(Pushes, MakeAStandingRobotSwayAndItRecovers) {
  for (const double force : {20.0, 60.0}) {
    SimulationConfig config = standing_robot();
    config.push = {.count = 10, .force = force};
    const Motion pushed = simulate(config, 2);
    EXPECT_NE(pushed.truth.walk.end, WalkEnd::kFell) << force;
    ASSERT_EQ(pushed.truth.waypoint_times.size(), 2U) << "it walks its way all the same";
    // Against a trunk of 12.6 kg on feet that give way: less than the free momentum, but felt.
    const double free = force * config.push.duration / 12.6;
    EXPECT_GT(largest_speed(pushed.truth, 5.0), 0.2 * free) << force;
    EXPECT_LT(largest_speed(pushed.truth, 5.0), 1.2 * free) << force;
  }
  EXPECT_LT(largest_speed(simulate(standing_robot(), 2).truth, 5.0), 0.01);
}

TEST(Pushes, ChangeNothingBeforeTheFirstAndNoOtherStream) {
  SimulationConfig config = standing_robot();
  const Motion without = simulate(config, 4);
  config.push.force = 200.0;  // of no push
  const Motion off = simulate(config, 4);
  config.push = {.count = 1, .force = 40.0, .duration = 0.2, .start = 2.0, .end = 2.2};
  const Motion with = simulate(config, 4);
  ASSERT_EQ(off.imu.size(), without.imu.size());
  for (std::size_t i = 0; i < without.imu.size(); ++i) {
    ASSERT_EQ(off.imu[i].specific_force, without.imu[i].specific_force);
    if (without.imu[i].stamp > 2 * kSecond) continue;
    ASSERT_EQ(with.imu[i].specific_force, without.imu[i].specific_force);
    ASSERT_EQ(with.imu[i].angular_velocity, without.imu[i].angular_velocity);
  }
  EXPECT_EQ(with.truth.samples[2000].gyro_bias, without.truth.samples[2000].gyro_bias);
  EXPECT_NE(with.truth.samples[850].velocity, without.truth.samples[850].velocity);
}

TEST(Pushes, AlsoActBeforeTheRecording) {
  SimulationConfig config = standing_robot();
  config.push = {.count = 1, .force = 40.0, .duration = 0.2, .start = 2.0, .end = 2.2};
  const Motion whole = simulate(config, 1);
  config.recording_start = 2.5;
  const Motion late = simulate(config, 1);
  EXPECT_EQ(late.truth.samples.front().T_world_body.translation,
            whole.truth.samples[1000].T_world_body.translation);
}

}  // namespace
}  // namespace aims
