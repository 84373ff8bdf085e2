// SPDX-License-Identifier: BSD-3-Clause
// Estimators whose sensors are missing, die or carry wrong stamps.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "estimator/registry.hpp"
#include "tests/support/kinematic_world.hpp"

namespace aims {
namespace {

using test::KinematicConfig;
using test::KinematicWorld;

class MissingSensors : public ::testing::Test {
 protected:
  MissingSensors() : world_(short_sequence()) { world_.advance(world_.duration(), deliveries_); }

  static KinematicConfig short_sequence() {
    KinematicConfig config;
    config.walk.distance = 2.5;
    config.corridor.end = 20.0;
    config.sensors.lidar_columns = 450;
    return config;
  }

  /// The result on the deliveries for which `keep` is true; `change` changes them before.
  EstimatorResult run(const char* name, const std::function<bool(Delivery&)>& keep) const {
    const auto estimator = *make_estimator(name, world_.rig());
    for (Delivery delivery : deliveries_) {
      if (keep(delivery)) estimator->consume(delivery);
    }
    estimator->finish();
    return estimator->result();
  }

  static bool is_scan(const Delivery& delivery) { return delivery.measurement.index() == 2; }
  static bool is_imu(const Delivery& delivery) { return delivery.measurement.index() == 0; }

  static HealthState worst(const EstimatorResult& result) {
    HealthState state = HealthState::kStarting;
    for (const HealthRow& row : result.health) state = std::max(state, row.state);
    return state;
  }

  /// Longest time between poses, or from the end of the standing start to the first.
  static Duration longest_gap(const EstimatorResult& result, Time start) {
    Duration longest = result.trajectory.front().stamp - start;
    for (std::size_t i = 1; i < result.trajectory.size(); ++i) {
      longest = std::max(longest, result.trajectory[i].stamp - result.trajectory[i - 1].stamp);
    }
    return longest;
  }

  KinematicWorld world_;
  std::vector<Delivery> deliveries_;
};

TEST_F(MissingSensors, AllThereIsHealthy) {
  for (const char* name : {"aims", "aims_d", "tfs_plus", "lio", "leg"}) {
    const EstimatorResult result = run(name, [](Delivery&) { return true; });
    EXPECT_EQ(worst(result), HealthState::kHealthy) << name;
  }
}

TEST_F(MissingSensors, WithoutALidarPosesComeAtASteadyRateFromTheStart) {
  for (const char* name : {"aims", "aims_d", "tfs", "lio", "leg"}) {
    const EstimatorResult result = run(name, [](Delivery& d) { return !is_scan(d); });
    ASSERT_GT(result.trajectory.size(), 20U) << name;
    EXPECT_LT(longest_gap(result, 2 * kSecond), 300 * kMillisecond) << name;
  }
}

TEST_F(MissingSensors, WithoutALidarLegsCarryTheEstimateAndItSaysSo) {
  const EstimatorResult result = run("aims_d", [](Delivery& d) { return !is_scan(d); });
  const Pose truth = world_.T_world_body(result.trajectory.back().stamp);
  EXPECT_NEAR(result.trajectory.back().pose.translation.x(), truth.translation.x(), 0.3);
  EXPECT_EQ(worst(result), HealthState::kDegraded);
}

TEST_F(MissingSensors, TheImuAloneCoastsWithGrowingCovariance) {
  const EstimatorResult result = run("lio", [](Delivery& d) { return is_imu(d); });
  ASSERT_GT(result.trajectory.size(), 20U);
  EXPECT_LT(longest_gap(result, 4 * kSecond), 300 * kMillisecond);
  EXPECT_EQ(worst(result), HealthState::kInvalid);
  EXPECT_GT(result.health.back().position_sigma, 10.0 * result.health[5].position_sigma);
}

TEST_F(MissingSensors, ASingleStampAheadIsDroppedAndTheRestIsUsed) {
  for (const char* name : {"aims", "aims_d", "lio"}) {
    const EstimatorResult clean = run(name, [](Delivery&) { return true; });
    int imu = 0;
    const EstimatorResult hit = run(name, [&imu](Delivery& delivery) {
      auto* sample = std::get_if<ImuSample>(&delivery.measurement);
      if (sample != nullptr && ++imu == 30) sample->stamp += 3 * kSecond;  // while standing
      return true;
    });
    EXPECT_EQ(hit.counts.at("imu.stamp_jump"), 1) << name;
    EXPECT_FALSE(hit.counts.contains("imu.late")) << name;
    ASSERT_EQ(hit.trajectory.size(), clean.trajectory.size()) << name;
    const Eigen::Vector3d difference =
        hit.trajectory.back().pose.translation - clean.trajectory.back().pose.translation;
    EXPECT_LT(difference.norm(), 0.02) << name;
  }
}

TEST_F(MissingSensors, AnImuOfNotANumberGivesNoPoseAndSaysWhy) {
  const EstimatorResult result = run("aims_d", [](Delivery& delivery) {
    if (auto* sample = std::get_if<ImuSample>(&delivery.measurement)) {
      sample->specific_force.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    return true;
  });
  EXPECT_TRUE(result.trajectory.empty());
  EXPECT_EQ(worst(result), HealthState::kInvalid);
}

TEST_F(MissingSensors, LegsWhosePoseJumpsAreInvalid) {
  const EstimatorResult result = run("leg", [](Delivery& delivery) {
    auto* legs = std::get_if<LegOdometrySample>(&delivery.measurement);
    if (legs != nullptr && legs->stamp > 4 * kSecond)
      legs->T_odom_base.translation.setConstant(1e6);
    return true;
  });
  EXPECT_EQ(worst(result), HealthState::kInvalid);
}

TEST_F(MissingSensors, ADeadLidarIsNamedAndItsReturnToo) {
  const EstimatorResult result = run("tfs_clean", [](Delivery& delivery) {
    return !is_scan(delivery) || delivery.arrival < 5 * kSecond || delivery.arrival > 7 * kSecond;
  });
  bool named = false;
  for (const HealthRow& row : result.health) {
    const bool dead = row.stamp > 5600 * kMillisecond && row.stamp < 7 * kSecond;
    if (dead) EXPECT_EQ(row.state, HealthState::kDegraded) << to_seconds(row.stamp);
    named = named || (dead && row.reasons.front() == "no LiDAR scans");
  }
  EXPECT_TRUE(named);
  EXPECT_EQ(result.health.back().state, HealthState::kHealthy);
}

}  // namespace
}  // namespace aims
