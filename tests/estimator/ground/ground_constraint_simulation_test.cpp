// SPDX-License-Identifier: BSD-3-Clause
// The ground constraint of `aims_d` on simulated sequences: its benefit, and its rejection of a
// ramp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/trajectory.hpp"
#include "estimator/aims/eskf_estimator.hpp"
#include "estimator/aims/presets.hpp"
#include "tests/estimator/simulated_sequence.hpp"

namespace aims {
namespace {

using testing::SimulatedSequence;

constexpr int kColumns = 450;  ///< a quarter of the LiDAR's

EstimatorResult estimate(const SimulatedSequence& sequence, const GroundConstraintConfig& ground) {
  EskfConfig config = eskf_preset("aims_d");
  config.ground_constraint = ground;
  EskfEstimator estimator(config, sequence.rig);
  for (const Delivery& delivery : sequence.deliveries) estimator.consume(delivery);
  estimator.finish();
  return estimator.result();
}

GroundConstraintConfig with_ground() {
  GroundConstraintConfig ground;
  ground.enabled = true;
  return ground;
}

GroundConstraintConfig without_ground() {
  GroundConstraintConfig ground;
  ground.enabled = false;
  return ground;
}

/// Accepts any flat ground as level.
GroundConstraintConfig without_level_test() {
  GroundConstraintConfig ground = with_ground();
  ground.min_tilt_gate = 1.0;
  ground.max_tilt_gate = 1.0;
  ground.max_bend = 1.0;
  ground.max_step = 10.0;
  ground.max_residual = 1.0;
  return ground;
}

/// Largest error of the height gained since the first pose [m].
double largest_height_error(const EstimatorResult& result, const Truth& truth) {
  const Trajectory body = body_trajectory(truth);
  const auto true_height = [&body](Time stamp) {
    return pose_at(body, stamp).value().translation.z();
  };
  if (result.trajectory.empty()) return std::numeric_limits<double>::infinity();
  const StampedPose& first = result.trajectory.front();
  double largest = 0.0;
  for (const StampedPose& each : result.trajectory) {
    const double gained = each.pose.translation.z() - first.pose.translation.z();
    const double true_gain = true_height(each.stamp) - true_height(first.stamp);
    largest = std::max(largest, std::abs(gained - true_gain));
  }
  return largest;
}

int count_of(const EstimatorResult& result, const char* name) {
  const auto found = result.counts.find(name);
  return found == result.counts.end() ? 0 : static_cast<int>(found->second);
}

TEST(GroundConstraintSimulation, LevelGroundKeepsTheHeightAfterATiltedStart) {
  SimulationConfig config = testing::straight_sequence(8.0, kColumns);
  config.imu.accelerometer.turn_on_bias = 0.06;  // twice the default: it tilts the start
  double worst_with = 0.0;
  double worst_without = 0.0;
  for (const std::uint64_t seed : {1, 2}) {
    const SimulatedSequence sequence = testing::simulate(config, seed);
    const EstimatorResult with = estimate(sequence, with_ground());
    worst_with = std::max(worst_with, largest_height_error(with, sequence.truth));
    worst_without = std::max(
        worst_without, largest_height_error(estimate(sequence, without_ground()), sequence.truth));
    EXPECT_GT(count_of(with, "ground.used"), 80) << "seed " << seed;
    EXPECT_EQ(count_of(with, "ground.not_level"), 0) << "seed " << seed;
  }
  EXPECT_LT(worst_with, 0.03);
  EXPECT_GT(worst_without, 1.5 * worst_with);
}

TEST(GroundConstraintSimulation, ARampIsRejectedAndItsHeightKept) {
  SimulationConfig config = testing::straight_sequence(10.0, kColumns);
  config.scene.ramp = {.start = 6.0, .length = 3.0, .grade = 0.06};
  const SimulatedSequence sequence = testing::simulate(config, 1);
  const EstimatorResult tested = estimate(sequence, with_ground());
  const EstimatorResult without = estimate(sequence, without_ground());
  const EstimatorResult untested = estimate(sequence, without_level_test());
  const double error = largest_height_error(tested, sequence.truth);
  EXPECT_GT(count_of(tested, "ground.used"), 20) << "before the ramp";
  EXPECT_GT(count_of(tested, "ground.not_level"), 5);
  EXPECT_LT(error, largest_height_error(without, sequence.truth) + 0.01);
  // Without the level test the ramp is flattened.
  EXPECT_EQ(count_of(untested, "ground.not_level"), 0);
  EXPECT_GT(largest_height_error(untested, sequence.truth), error + 0.03);
}

}  // namespace
}  // namespace aims
