// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lins/lins.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <variant>

#include "tests/estimator/baselines/room_scan.hpp"
#include "tests/support/kinematic_world.hpp"

namespace aims::lins {
namespace {

using aims::testing::position_error;

bool is_imu(const Delivery& delivery) { return delivery.measurement.index() == 0; }
bool is_legs(const Delivery& delivery) { return delivery.measurement.index() == 1; }

/// A walk of 2.5 m between end walls 21.5 m apart.
class LinsInABox : public ::testing::Test {
 protected:
  LinsInABox() : world_(box()) { world_.advance(world_.duration(), deliveries_); }

  static aims::test::KinematicConfig box() {
    aims::test::KinematicConfig config;
    config.walk.distance = 2.5;
    config.walk.there_and_back = false;
    config.corridor.end = 20.0;
    return config;
  }

  using Change = std::function<bool(Delivery&)>;

  /// The result on the deliveries for which `keep` is true; `keep` may change them.
  EstimatorResult run(
      const Config& config, const Change& keep = [](Delivery&) { return true; },
      const std::optional<SensorRig>& rig = {}) const {
    Lins estimator(config, rig.value_or(world_.rig()));
    for (Delivery delivery : deliveries_) {
      if (keep(delivery)) estimator.consume(delivery);
    }
    estimator.finish();
    return estimator.result();
  }

  /// Largest distance [m] from the truth after alignment at the first pose.
  double largest_error(const EstimatorResult& result) const {
    const StampedPose& first = result.trajectory.front();
    const Pose T_world_odom = world_.T_world_body(first.stamp) * first.pose.inverse();
    double largest = 0.0;
    for (const StampedPose& each : result.trajectory) {
      const Pose truth = world_.T_world_body(each.stamp);
      largest = std::max(largest, position_error(truth, T_world_odom * each.pose));
    }
    return largest;
  }

  aims::test::KinematicWorld world_;
  std::vector<Delivery> deliveries_;
};

TEST_F(LinsInABox, FollowsTheWalk) {
  const EstimatorResult result = run(corridor());
  ASSERT_GT(result.trajectory.size(), 50U);
  EXPECT_EQ(result.trajectory.size(), result.diagnostics.scans.size());
  EXPECT_LT(largest_error(result), 1.2);
  for (const char* name : {"filter.rejected", "filter.diverged"}) {
    EXPECT_FALSE(result.counts.contains(name)) << name;
  }
}

TEST_F(LinsInABox, LegsMakeNoDifference) {
  const EstimatorResult with = run(corridor());
  const EstimatorResult without = run(corridor(), [](Delivery& each) { return !is_legs(each); });
  ASSERT_EQ(with.trajectory.size(), without.trajectory.size());
  EXPECT_EQ(with.trajectory.back().pose.translation, without.trajectory.back().pose.translation);
}

TEST_F(LinsInABox, ReportsFromTheSecondScanOnAndItsDegeneracy) {
  const EstimatorResult result = run(corridor());
  const auto value = [&](std::size_t scan, const char* name) {
    return result.diagnostics.value(scan, name);
  };
  EXPECT_LT(result.trajectory.front().pose.translation.norm(), 0.1);
  EXPECT_EQ(value(0, "filter_iterations"), 0.0);
  EXPECT_TRUE(std::isnan(value(0, "smallest_eigenvalue")));
  EXPECT_GT(value(1, "filter_iterations"), 0.0);
  EXPECT_GT(value(1, "smallest_eigenvalue"), 0.0);
  EXPECT_GE(value(1, "condition_number"), 1.0);
  EXPECT_LE(value(1, "localizability"), value(1, "points_used"));
  EXPECT_LE(value(1, "points_used"), value(1, "plane_matches") + value(1, "edge_matches"));
  EXPECT_EQ(value(1, "diverged"), 0.0);
  EXPECT_LT(value(1, "residual_rms"), 0.2);
  const std::size_t last = result.diagnostics.scans.size() - 1;
  EXPECT_GT(value(last, "plane_matches"), 10.0);
  EXPECT_GT(value(last, "edge_matches"), 5.0);
  int registered = 0;
  for (std::size_t i = 0; i <= last; ++i) registered += !std::isnan(value(i, "mapping_matches"));
  EXPECT_GT(registered, static_cast<int>(last / 5));
  EXPECT_LT(registered, static_cast<int>(last / 2));
}

TEST_F(LinsInABox, TheMapCorrectsThePoseOfTheNextScan) {
  Config odometry_alone = corridor();
  odometry_alone.mapping.min_interval = 100.0;
  const EstimatorResult without = run(odometry_alone);
  const EstimatorResult with = run(corridor());
  std::size_t scan = 1;
  while (std::isnan(with.diagnostics.value(scan, "mapping_matches"))) ++scan;
  ASSERT_GT(with.diagnostics.value(scan, "mapping_matches"), 50.0);
  const auto position = [](const EstimatorResult& result, std::size_t i) {
    return result.trajectory[i].pose.translation;
  };
  EXPECT_EQ(position(with, scan), position(without, scan));
  EXPECT_NE(position(with, scan + 1), position(without, scan + 1));
}

TEST_F(LinsInABox, ScansWithoutImuAreCountedAndSkipped) {
  const Time begin = deliveries_.front().arrival + 3 * kSecond;
  const EstimatorResult result = run(corridor(), [&](Delivery& each) {
    return !is_imu(each) || each.arrival < begin || each.arrival > begin + kSecond;
  });
  EXPECT_GT(result.counts.at("lidar.without_imu"), 2);
  EXPECT_TRUE(std::isfinite(largest_error(result)));
  EXPECT_TRUE(run(corridor(), [](Delivery& each) { return !is_imu(each); }).trajectory.empty());
}

// The axes of the IMU do not matter once the rig says how it is mounted.
TEST_F(LinsInABox, ReadsTheImuInAxesOfTheLidar) {
  const Eigen::Quaterniond R = so3_exp({0.0, 0.0, 1.2});
  SensorRig rig = world_.rig();
  rig.T_body_lidar.rotation = R * rig.T_body_lidar.rotation;
  rig.T_body_lidar.translation = R * rig.T_body_lidar.translation;
  const EstimatorResult turned = run(
      corridor(),
      [&](Delivery& each) {
        if (auto* sample = std::get_if<ImuSample>(&each.measurement)) {
          sample->angular_velocity = R * sample->angular_velocity;
          sample->specific_force = R * sample->specific_force;
        }
        return true;
      },
      rig);
  const EstimatorResult result = run(corridor());
  ASSERT_EQ(turned.trajectory.size(), result.trajectory.size());
  for (std::size_t i = 0; i < 20; ++i) {
    const Pose& pose = result.trajectory[i].pose;
    EXPECT_LT(position_error(turned.trajectory[i].pose, {pose.rotation, R * pose.translation}),
              1e-3);
  }
}

// As in the published program the IMU predicts up to the stamp of a scan, its first firing.
TEST_F(LinsInABox, ByDefaultTheImuDuringTheLastScanDoesNotMatter) {
  const auto* last = std::get_if<LidarScanPtr>(&deliveries_.back().measurement);
  for (const Delivery& each : deliveries_) {
    if (const auto* scan = std::get_if<LidarScanPtr>(&each.measurement)) last = scan;
  }
  const Time stamp = (*last)->stamp;
  const Change disturb = [&](Delivery& each) {
    auto* sample = std::get_if<ImuSample>(&each.measurement);
    if (sample != nullptr && sample->stamp > stamp + 30 * kMillisecond) {
      sample->angular_velocity.z() += 1.0;
    }
    return true;
  };
  Config config = corridor();
  EXPECT_EQ(run(config, disturb).trajectory.back().pose.translation,
            run(config).trajectory.back().pose.translation);
  config.filter.predict_until = PredictionEnd::kScanEnd;
  EXPECT_NE(run(config, disturb).trajectory.back().pose.translation,
            run(config).trajectory.back().pose.translation);
}

TEST_F(LinsInABox, AnImpossibleImuEndsNormally) {
  const Time begin = deliveries_.front().arrival + 3 * kSecond;
  const EstimatorResult result = run(corridor(), [&](Delivery& each) {
    auto* sample = std::get_if<ImuSample>(&each.measurement);
    if (sample != nullptr && each.arrival > begin) sample->specific_force.x() = 150.0;
    return true;
  });
  EXPECT_GT(result.trajectory.size(), 10U) << "poses before the force";
  for (const StampedPose& each : result.trajectory) {
    ASSERT_TRUE(each.pose.translation.allFinite());
    ASSERT_TRUE(each.pose.rotation.coeffs().allFinite());
  }
}

TEST(LinsPresets, OnlyThePublishedOneClosesLoops) {
  EXPECT_TRUE(Config().mapping.loop.enabled);
  EXPECT_EQ(Config().mapping.loop.radius, 5.0);
  EXPECT_FALSE(corridor().mapping.loop.enabled);
  EXPECT_FALSE(lego_loam::Config().mapping.loop.enabled);
}

}  // namespace
}  // namespace aims::lins
