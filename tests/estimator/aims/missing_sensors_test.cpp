// SPDX-License-Identifier: BSD-3-Clause
// Estimators whose sensors are missing, die or carry wrong stamps.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "estimator/registry.hpp"
#include "tests/support/kinematic_world.hpp"

namespace aims {
namespace {

class MissingSensors : public ::testing::Test {
 protected:
  MissingSensors() : world_(test::short_walk()), deliveries_(test::record(world_)) {}

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
  static bool is_legs(const Delivery& delivery) { return delivery.measurement.index() == 1; }
  static bool is_imu(const Delivery& delivery) { return delivery.measurement.index() == 0; }

  /// Whether it arrived after `begin`, and at `end` or before [s].
  static bool within(const Delivery& delivery, double begin, double end) {
    return delivery.arrival > from_seconds(begin) && delivery.arrival <= from_seconds(end);
  }

  /// Largest error of a result [m].
  double error(const EstimatorResult& result) const {
    return test::largest_error(result.trajectory, world_);
  }

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

  test::KinematicWorld world_;
  std::vector<Delivery> deliveries_;
};

TEST_F(MissingSensors, AllThereIsHealthy) {
  for (const char* name : {"aims", "aims_d", "tfs_plus", "lio", "leg"}) {
    const EstimatorResult result = run(name, [](Delivery&) { return true; });
    EXPECT_EQ(worst(result), HealthState::kHealthy) << name;
    EXPECT_EQ(result.health.back().stamp, deliveries_.back().arrival)
        << name << ": its last row stands at the end of the stream, not at a whole second";
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

TEST_F(MissingSensors, WhatComesBehindAPredictionByTheImuIsNotOfBeforeTheStart) {
  const int before = run("aims_d", [](Delivery&) { return true; }).counts.at("leg.before_start");
  for (Delivery& each : deliveries_) {
    if (!is_imu(each) && within(each, 5.0, 8.0)) each.arrival = from_seconds(8.0);
  }
  std::ranges::stable_sort(deliveries_, {}, &Delivery::arrival);
  const EstimatorResult result = run("aims_d", [](Delivery&) { return true; });
  EXPECT_EQ(result.counts.at("leg.before_start"), before);
  EXPECT_GT(result.counts.at("leg.after_prediction"), 100);
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
    if (dead) {
      EXPECT_EQ(row.state, HealthState::kDegraded) << to_seconds(row.stamp);
    }
    named = named || (dead && row.reasons.front() == "no LiDAR scans");
  }
  EXPECT_TRUE(named);
  EXPECT_EQ(result.health.back().state, HealthState::kHealthy);
}

TEST_F(MissingSensors, ThreeSecondsWithoutImuAreBridged) {
  const EstimatorResult result =
      run("aims", [](Delivery& d) { return !(is_imu(d) && within(d, 4.0, 7.0)); });
  EXPECT_GT(result.counts.at("imu.bridged"), 0);
  EXPECT_LT(error(result), 0.3);
}

TEST_F(MissingSensors, TwoSecondsWithoutLidarAreBridged) {
  const EstimatorResult result =
      run("aims", [](Delivery& d) { return !(is_scan(d) && within(d, 4.0, 6.0)); });
  EXPECT_LT(error(result), 0.3);
}

TEST_F(MissingSensors, PosesGoOnWithoutLidar) {
  for (const char* name : {"aims", "lio", "leg"}) {
    const EstimatorResult result =
        run(name, [](Delivery& d) { return !(is_scan(d) && within(d, 4.0, 7.0)); });
    const Time first = result.trajectory.front().stamp;
    EXPECT_LE(longest_gap(result, first), kMaxPoseInterval + 10 * kMillisecond) << name;
    if (result.diagnostics.scans.empty()) continue;
    const auto bridged = result.trajectory.size() - result.diagnostics.scans.size();
    EXPECT_NEAR(static_cast<double>(bridged), 12.0, 1.0) << name;
  }
}

TEST_F(MissingSensors, LegsMayBeMissing) {
  EXPECT_LT(error(run("aims", [](Delivery& d) { return !is_legs(d); })), 0.05);
}

TEST_F(MissingSensors, WithoutImuTheTrajectoryIsEmpty) {
  EXPECT_TRUE(run("aims", [](Delivery& d) { return !is_imu(d); }).trajectory.empty());
}

TEST_F(MissingSensors, EmptyAndBrokenScansAreCounted) {
  int count = 0;
  const EstimatorResult result = run("aims", [&count](Delivery& d) {
    const auto* scan = std::get_if<LidarScanPtr>(&d.measurement);
    if (scan == nullptr || ++count % 3 != 0) return true;
    auto broken = std::make_shared<LidarScan>(**scan);
    if (count % 2 == 0) {
      broken->points.clear();
    } else {
      const float nan = std::numeric_limits<float>::quiet_NaN();
      for (LidarPoint& point : broken->points) point.position.x() = nan;
    }
    d.measurement = LidarScanPtr(broken);
    return true;
  });
  EXPECT_GT(result.counts.at("lidar.no_update"), 10);
  EXPECT_LT(error(result), 0.1);
}

}  // namespace
}  // namespace aims
