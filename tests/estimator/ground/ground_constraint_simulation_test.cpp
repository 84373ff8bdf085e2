// SPDX-License-Identifier: BSD-3-Clause
// The ground constraint on simulated sequences: its benefit, its rejection of a ramp, and a 50 Hz
// IMU on a vibrating trunk.
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

EstimatorResult estimate(const SimulatedSequence& sequence, const EskfConfig& config) {
  EskfEstimator estimator(config, sequence.rig);
  for (const Delivery& delivery : sequence.deliveries) estimator.consume(delivery);
  estimator.finish();
  return estimator.result();
}

EstimatorResult estimate(const SimulatedSequence& sequence, const GroundConstraintConfig& ground) {
  EskfConfig config = eskf_preset("aims_d");
  config.ground_constraint = ground;
  return estimate(sequence, config);
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

/// Mean tilt between the estimated and the true attitude over the second half [rad].
double mean_tilt_error(const EstimatorResult& result, const Truth& truth) {
  const Trajectory body = body_trajectory(truth);
  const std::size_t half = result.trajectory.size() / 2;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t i = half; i < result.trajectory.size(); ++i) {
    const StampedPose& estimate = result.trajectory[i];
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    const Eigen::Quaterniond true_attitude = pose_at(body, estimate.stamp).value().rotation;
    sum += (estimate.pose.rotation.conjugate() * up - true_attitude.conjugate() * up).head<2>();
  }
  return sum.norm() / static_cast<double>(result.trajectory.size() - half);
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
  SimulationConfig config = testing::straight_sequence(14.0, kColumns);
  config.scene.ramp = {.start = 4.0, .length = 7.0, .grade = 0.05};
  const SimulatedSequence sequence = testing::simulate(config, 1);
  const EstimatorResult tested = estimate(sequence, with_ground());
  const EstimatorResult without = estimate(sequence, without_ground());
  const double error = largest_height_error(tested, sequence.truth);
  EXPECT_GT(count_of(tested, "ground.used"), 20) << "before the ramp";
  EXPECT_GT(count_of(tested, "ground.not_level"), 20);
  EXPECT_LT(error, largest_height_error(without, sequence.truth) + 0.01);
  EXPECT_LT(error, 0.05) << "of a climb of 0.35 m";
}

/// A start on a slope of 8 % that ends after 4 m, up to 20 m.
SimulatedSequence from_a_slope(std::uint64_t seed) {
  SimulationConfig config = testing::straight_sequence(18.0, kColumns);
  config.scene.ramp = {.start = 0.0, .length = 8.0, .grade = 0.08};
  config.route.points = {{"a", 4.0, 0.0}, {"b", 17.0, 0.0}};
  config.imu.accelerometer.turn_on_bias = 0.2;
  return testing::simulate(config, seed);
}

TEST(GroundConstraintSimulation, AStartOnASlopeThatPassedForLevelIsLevelledAtItsEnd) {
  const SimulatedSequence sequence = from_a_slope(7);
  const EstimatorResult result = estimate(sequence, with_ground());
  EXPECT_EQ(count_of(result, "ground.start_was_sloped"), 1);
  EXPECT_EQ(count_of(result, "map.restarted"), 1);
  EXPECT_LT(mean_tilt_error(result, sequence.truth), 8e-3);
}

TEST(GroundConstraintSimulation, AStartOnASlopeThatIsSeenAsOneIsLevelledAtItsEndToo) {
  const SimulatedSequence sequence = from_a_slope(3);
  const EstimatorResult result = estimate(sequence, with_ground());
  EXPECT_EQ(count_of(result, "ground.start_was_sloped"), 0);
  EXPECT_EQ(count_of(result, "map.restarted"), 1) << "at the first level ground";
  EXPECT_LT(mean_tilt_error(result, sequence.truth), 4e-3);
  EXPECT_LT(largest_height_error(result, sequence.truth), 0.05);
}

/// What recordings show: samples of an instant on a vibrating trunk at 50 Hz, a mount 0.2 degrees
/// off, and an accelerometer that tilts the start by up to 15 mrad.
TEST(GroundConstraintSimulation, AVibratingImuAndAWrongMountLeaveLevelGroundInUse) {
  SimulationConfig config = testing::straight_sequence(10.0, kColumns);
  config.imu.accelerometer.turn_on_bias = 0.15;
  config.imu.sampling = ImuSampling::kPoint;
  config.imu.vibration.level = 1.0;
  config.calibration.rotation_sigma_deg = 0.2;
  const SimulatedSequence sequence = testing::simulate(config, 1);
  EskfConfig estimator = eskf_preset("tfs_plus");
  const EstimatorResult result = estimate(sequence, estimator);
  const double error = largest_height_error(result, sequence.truth);
  EXPECT_LT(error, 0.05);
  EXPECT_EQ(count_of(result, "ground.not_level"), 0);
  EXPECT_LT(mean_tilt_error(result, sequence.truth), 0.008) << "hardly more than the mount";
  estimator.ground_constraint.enabled = false;
  EXPECT_GT(largest_height_error(estimate(sequence, estimator), sequence.truth), 1.2 * error);
}

}  // namespace
}  // namespace aims
