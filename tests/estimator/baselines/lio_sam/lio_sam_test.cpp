// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/lio_sam.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/estimator/baselines/room_scan.hpp"
#include "tests/support/kinematic_world.hpp"

namespace aims::lio_sam {
namespace {

using aims::testing::position_error;

test::KinematicConfig walk_past_recesses() {
  test::KinematicConfig config;
  config.walk.distance = 4.0;
  config.walk.there_and_back = false;
  config.corridor.recess_depth = 0.5;
  return config;
}

struct Walked {
  EstimatorResult result;
  std::vector<Delivery> deliveries;
  std::vector<Eigen::Vector3f> map;
};

template <class Change>
Walked run(const test::KinematicConfig& world_config, const Config& config, Change change) {
  test::KinematicWorld world(world_config);
  Walked run;
  world.advance(world.duration(), run.deliveries);
  LioSam estimator(config, world.rig());
  for (Delivery& each : run.deliveries) {
    if (change(each)) estimator.consume(each);
  }
  estimator.finish();
  run.result = estimator.result();
  run.map = estimator.map_points();
  return run;
}

bool unchanged(const Delivery&) { return true; }

/// Error of the last position, with the first one and the heading as they are.
double end_error(const Walked& run, const test::KinematicConfig& config) {
  test::KinematicWorld world(config);
  const StampedPose& first = run.result.trajectory.front();
  const StampedPose& last = run.result.trajectory.back();
  const Pose expected = world.T_world_body(first.stamp).inverse() * world.T_world_body(last.stamp);
  return (first.pose.inverse() * last.pose * expected.inverse()).translation.norm();
}

TEST(LioSam, FollowsAWalkAndReportsEveryScan) {
  const Walked walk = run(walk_past_recesses(), corridor(), unchanged);
  EXPECT_LT(end_error(walk, walk_past_recesses()), 0.3);
  const Trajectory& trajectory = walk.result.trajectory;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    EXPECT_EQ(trajectory[i].stamp - trajectory[i - 1].stamp, 100 * kMillisecond);
  }
  EXPECT_EQ(walk.result.diagnostics.scans.size(), trajectory.size());
  EXPECT_GT(walk.map.size(), 1000U);
}

TEST(LioSam, RegistersEverySecondScanAndReportsItsDegeneracy) {
  const Walked walk = run(walk_past_recesses(), corridor(), unchanged);
  const Diagnostics& diagnostics = walk.result.diagnostics;
  int updated = 0;
  for (std::size_t i = 0; i < diagnostics.scans.size(); ++i) {
    EXPECT_EQ(std::isnan(diagnostics.value(i, "is_degenerate")), i % 2 == 1) << i;
    if (!diagnostics.updated(i)) continue;
    EXPECT_GT(diagnostics.value(i, "smallest_eigenvalue"), 0.0) << i;
    ++updated;
  }
  EXPECT_GT(updated, 20);
}

TEST(LioSam, TheSameStreamYieldsTheSameNumbers) {
  const Walked a = run(walk_past_recesses(), corridor(), unchanged);
  const Walked b = run(walk_past_recesses(), corridor(), unchanged);
  ASSERT_EQ(a.result.trajectory.size(), b.result.trajectory.size());
  for (std::size_t i = 0; i < a.result.trajectory.size(); ++i) {
    EXPECT_EQ(a.result.trajectory[i].pose.translation, b.result.trajectory[i].pose.translation);
  }
}

TEST(LioSam, WithoutOrientationAFilterStandsInForIt) {
  AttitudeFilter filter;
  const auto with_orientation = [&](Delivery& each) {
    if (auto* sample = std::get_if<ImuSample>(&each.measurement)) {
      sample->orientation = filter.update(*sample);
    }
    return true;
  };
  const Walked without = run(walk_past_recesses(), corridor(), unchanged);
  const Walked with = run(walk_past_recesses(), corridor(), with_orientation);
  EXPECT_GT(without.result.counts.at("imu.without_orientation"), 100);
  EXPECT_FALSE(with.result.counts.contains("imu.without_orientation"));
  EXPECT_EQ(without.result.trajectory.back().pose.translation,
            with.result.trajectory.back().pose.translation);
}

TEST(LioSam, UsesTheOrientationOfTheImu) {
  const Eigen::Quaterniond tilt = so3_exp({0.1, 0.0, 0.0});
  const auto tilted = [&](Delivery& each) {
    if (auto* sample = std::get_if<ImuSample>(&each.measurement)) sample->orientation = tilt;
    return true;
  };
  const Walked walk = run(walk_past_recesses(), corridor(), tilted);
  EXPECT_NEAR(angles_of(walk.result.trajectory.front().pose.rotation).roll, 0.1, 1e-6);
}

TEST(LioSam, ScansThatTheImuDoesNotCoverAreDropped) {
  const auto gap = [](const Delivery& each) {
    const auto* sample = std::get_if<ImuSample>(&each.measurement);
    return sample == nullptr || sample->stamp < 3 * kSecond || sample->stamp > 4 * kSecond;
  };
  const Walked walk = run(walk_past_recesses(), corridor(), gap);
  EXPECT_GT(walk.result.counts.at("lidar.without_imu"), 0);
  EXPECT_TRUE(walk.result.trajectory.back().pose.translation.allFinite());
}

TEST(LioSam, SurvivesAnImuThatRaves) {
  const auto raving = [](Delivery& each) {
    auto* sample = std::get_if<ImuSample>(&each.measurement);
    if (sample != nullptr && sample->stamp > 3 * kSecond) {
      sample->specific_force = {120.0, -90.0, 60.0};
      sample->angular_velocity = {20.0, -15.0, 25.0};
    }
    return true;
  };
  const Walked walk = run(walk_past_recesses(), corridor(), raving);
  const Diagnostics& diagnostics = walk.result.diagnostics;
  EXPECT_GT(diagnostics.value(diagnostics.scans.size() - 1, "imu_resets"), 0.0);
  for (const StampedPose& each : walk.result.trajectory) {
    ASSERT_TRUE(each.pose.translation.allFinite());
    ASSERT_LT(each.pose.translation.norm(), 1e5);
  }
}

TEST(LioSam, StatesWhatItNeeds) {
  const Requirements needs = requirements_of(Config());
  EXPECT_TRUE(needs.lidar && needs.imu && needs.rings && needs.point_times && needs.orientation);
  EXPECT_FALSE(needs.legs);
}

TEST(LioSam, ThePresetsAreThoseOfThePublishedProgram) {
  const Config published;
  EXPECT_EQ(published.features.surface_voxel, 0.4);
  EXPECT_EQ(published.mapping.edge_voxel, 0.2);
  EXPECT_EQ(published.mapping.surface_voxel, 0.4);
  EXPECT_EQ(corridor().features.surface_voxel, 0.2);
  EXPECT_EQ(corridor().mapping.edge_voxel, 0.1);
  EXPECT_EQ(corridor().mapping.surface_voxel, 0.2);
}

}  // namespace
}  // namespace aims::lio_sam
