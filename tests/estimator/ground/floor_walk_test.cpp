// SPDX-License-Identifier: BSD-3-Clause
// The floor constraint of `aims_d` on simulated walks: what it is worth, and that it knows a ramp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/trajectory.hpp"
#include "estimator/registry.hpp"
#include "tests/estimator/simulated_walk.hpp"

namespace aims {
namespace {

using testing::SimulatedWalk;

constexpr int kColumns = 450;  ///< a quarter of the LiDAR's

EstimatorResult estimate(const SimulatedWalk& walk, const FloorConfig& floor) {
  EstimatorConfig config;
  config.directional.floor = floor;
  const auto estimator = make_estimator("aims_d", config, walk.rig).value();
  for (const Delivery& delivery : walk.deliveries) estimator->consume(delivery);
  estimator->finish();
  return estimator->result();
}

FloorConfig without_floor() {
  FloorConfig floor;
  floor.enabled = false;
  return floor;
}

/// One that takes whatever is flat for level.
FloorConfig credulous_floor() {
  FloorConfig floor;
  floor.tilt = 1.0;
  floor.max_tilt = 1.0;
  floor.bend = 1.0;
  floor.step = 10.0;
  floor.max_residual = 1.0;
  return floor;
}

/// Largest error of the height gained since the first pose [m].
double largest_height_error(const EstimatorResult& report, const Truth& truth) {
  const Trajectory body = body_trajectory(truth);
  const auto true_height = [&body](Time stamp) {
    return pose_at(body, stamp).value().translation.z();
  };
  if (report.trajectory.empty()) return std::numeric_limits<double>::infinity();
  const StampedPose& first = report.trajectory.front();
  double largest = 0.0;
  for (const StampedPose& each : report.trajectory) {
    const double gained = each.pose.translation.z() - first.pose.translation.z();
    const double truly = true_height(each.stamp) - true_height(first.stamp);
    largest = std::max(largest, std::abs(gained - truly));
  }
  return largest;
}

int count_of(const EstimatorResult& report, const char* name) {
  const auto found = report.counts.find(name);
  return found == report.counts.end() ? 0 : static_cast<int>(found->second);
}

TEST(FloorWalk, ALevelFloorHoldsTheHeightThatATiltedStartWouldLose) {
  SimulationConfig config = testing::straight_walk(8.0, kColumns);
  config.imu.accelerometer.turn_on_bias = 0.06;  // twice the default: it tilts the start
  double worst_with = 0.0;
  double worst_without = 0.0;
  for (const std::uint64_t seed : {1, 2}) {
    const SimulatedWalk walk = testing::simulate(config, seed);
    const EstimatorResult with = estimate(walk, {});
    worst_with = std::max(worst_with, largest_height_error(with, walk.truth));
    worst_without =
        std::max(worst_without, largest_height_error(estimate(walk, without_floor()), walk.truth));
    EXPECT_GT(count_of(with, "floor.used"), 80) << "seed " << seed;
    EXPECT_EQ(count_of(with, "floor.not_level"), 0) << "seed " << seed;
  }
  EXPECT_LT(worst_with, 0.03);
  EXPECT_GT(worst_without, 1.5 * worst_with);
}

TEST(FloorWalk, ARampIsNoLevelFloorAndItsHeightIsKept) {
  SimulationConfig config = testing::straight_walk(10.0, kColumns);
  config.scene.ramp = {.start = 6.0, .length = 3.0, .grade = 0.06};
  const SimulatedWalk walk = testing::simulate(config, 1);
  const EstimatorResult wary = estimate(walk, {});
  const EstimatorResult without = estimate(walk, without_floor());
  const EstimatorResult credulous = estimate(walk, credulous_floor());
  const double error = largest_height_error(wary, walk.truth);
  EXPECT_GT(count_of(wary, "floor.used"), 20) << "before the ramp";
  EXPECT_GT(count_of(wary, "floor.not_level"), 5);
  EXPECT_LT(error, largest_height_error(without, walk.truth) + 0.01);
  // What the refusals are worth: a floor that takes the ramp for level flattens it.
  EXPECT_EQ(count_of(credulous, "floor.not_level"), 0);
  EXPECT_GT(largest_height_error(credulous, walk.truth), error + 0.03);
}

}  // namespace
}  // namespace aims
