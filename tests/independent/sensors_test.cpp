// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/independent/cells.hpp"
#include "tests/independent/inertial.hpp"
#include "tests/independent/legs.hpp"
#include "tests/independent/lidar.hpp"

namespace aims::independent {
namespace {

constexpr std::uint64_t kSeed = 11;

Walk walk_of(double length) { return Walk({.length = length, .seed = kSeed}); }

/// Deviation per channel of the vibration, sampled or averaged at that rate while walking.
Vector6d vibration_deviation(const Walk& walk, const Vibration& vibration, double rate_hz,
                             bool mean) {
  Vector6d squares = Vector6d::Zero();
  int count = 0;
  for (double t = walk.start() + 1.0; t < walk.end() - 1.0; t += 1.0 / rate_hz, ++count) {
    Vector6d value = vibration.at(t);
    for (int i = 1; mean && i < 20; ++i) value += vibration.at(t - i / (20.0 * rate_hz));
    squares += (mean ? Vector6d(value / 20.0) : value).cwiseAbs2();
  }
  return (squares / count).cwiseSqrt();
}

TEST(Vibration, HasItsDeviationAtEveryRateAndAliases) {
  std::printf("seed %lu\n", static_cast<unsigned long>(kSeed));
  const Walk walk = walk_of(40.0);
  const Vibration vibration(walk, 0.4, 0.02, kSeed);
  for (const double rate_hz : {50.0, 100.0, 200.0, 400.0}) {
    const Vector6d deviation = vibration_deviation(walk, vibration, rate_hz, false);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(deviation[axis], 0.02, 0.003) << rate_hz;
      EXPECT_NEAR(deviation[3 + axis], 0.4, 0.06) << rate_hz;
    }
  }
  // A mean over the 20 ms interval would remove most of it: what a point sample has, aliased.
  const Vector6d mean = vibration_deviation(walk, vibration, 50.0, true);
  EXPECT_LT(mean.head<3>().maxCoeff(), 0.6 * 0.02);
  EXPECT_LT(mean.tail<3>().maxCoeff(), 0.6 * 0.4);
}

TEST(Vibration, IsNoneWhileStandingAndIntegratesToZero) {
  const Walk walk = walk_of(10.0);
  const Vibration vibration(walk, 0.4, 0.02, kSeed);
  EXPECT_EQ(vibration.at(1.0), Vector6d::Zero());
  EXPECT_LT(vibration.at(walk.duration()).norm(), 1e-3);
  Vector6d integral = Vector6d::Zero();
  for (double t = 0.0; t < walk.duration(); t += 1e-4) integral += 1e-4 * vibration.at(t);
  EXPECT_LT(integral.tail<3>().cwiseAbs().maxCoeff(), 2e-3);
  EXPECT_LT(integral.head<3>().cwiseAbs().maxCoeff(), 1e-4);
}

/// Autocorrelation of a channel at that lag, over its variance.
double autocorrelation(const std::vector<double>& values, std::size_t lag) {
  double product = 0.0;
  double square = 0.0;
  for (std::size_t i = lag; i < values.size(); ++i) {
    product += values[i] * values[i - lag];
    square += values[i] * values[i];
  }
  return product / square;
}

TEST(Vibration, IsNotWhite) {
  const Walk walk = walk_of(40.0);
  const Vibration vibration(walk, 0.4, 0.02, kSeed);
  std::vector<double> values;
  for (double t = walk.start(); t < walk.end(); t += 1e-3) values.push_back(vibration.at(t)[5]);
  EXPECT_GT(autocorrelation(values, 1), 0.8);
  EXPECT_LT(autocorrelation(values, 8), 0.0);  // half a period of the middle frequencies
}

TEST(Inertial, StandingSamplesHaveNoiseBiasAndGravity) {
  const Walk walk = walk_of(3.0);
  InertialOptions options;
  options.seed = kSeed;
  const std::vector<ImuSample> samples = sample_inertial(walk, options);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  const int count = 590;  // of the 3 s of standing at 200 Hz
  for (int i = 0; i < count; ++i) sum += samples[i].specific_force;
  const Eigen::Vector3d mean = sum / count;
  for (int i = 0; i < count; ++i) squares += (samples[i].specific_force - mean).cwiseAbs2();
  const Eigen::Vector3d deviation = (squares / count).cwiseSqrt();
  EXPECT_LT((mean - kGravity * Eigen::Vector3d::UnitZ()).norm(), 0.15);
  EXPECT_GT((mean - kGravity * Eigen::Vector3d::UnitZ()).norm(), 1e-3);
  EXPECT_NEAR(deviation.norm(), std::sqrt(3.0) * 1.0e-3 * std::sqrt(200.0), 2e-3);
  EXPECT_EQ(samples[0].stamp, 5 * kMillisecond);
}

TEST(Legs, HaveTheirScaleAndLoss) {
  const Walk walk = walk_of(60.0);
  const auto samples = sample_legs(walk, Pose{}, {.scale = 1.045, .seed = kSeed});
  const double sent = std::floor(walk.duration() * 200.0);
  EXPECT_NEAR(1.0 - static_cast<double>(samples.size()) / sent, 0.04, 0.01);
  double product = 0.0;
  double square = 0.0;
  std::size_t bursts = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t = to_seconds(samples[i].stamp);
    if (i > 0 && samples[i].stamp - samples[i - 1].stamp > 25 * kMillisecond) ++bursts;
    if (t > walk.far_end()) continue;
    const BodyState truth = walk.state(t);
    const double forward = (truth.T_world_body.rotation.conjugate() * truth.velocity).x();
    product += samples[i].linear_velocity.x() * forward;
    square += forward * forward;
  }
  EXPECT_NEAR(product / square, 1.045, 0.005);
  EXPECT_GT(bursts, 10u);
}

TEST(Legs, PoseIsTheIntegralOfTheTwist) {
  const Walk walk = walk_of(20.0);
  LegOptions options;
  options.white_noise = options.step_noise = options.standing_noise = 0.0;
  options.heading_drift = 0.0;
  options.scale = 1.0;
  const auto samples = sample_legs(walk, Pose{}, options);
  const Eigen::Vector3d moved =
      walk.pose(to_seconds(samples.back().stamp)).translation - walk.pose(0.0).translation;
  EXPECT_LT((samples.back().T_odom_base.translation - moved).norm(), 0.02);
}

LidarOptions lidar_options(std::string_view rings, double max_range) {
  return {.elevations_deg = *ring_elevations_deg(rings), .max_range = max_range, .seed = kSeed};
}

TEST(Lidar, RingTablesRiseAndDiffer) {
  for (const auto& [name, count] :
       {std::pair{"uneven", 16u}, std::pair{"uniform", 16u}, std::pair{"32", 32u}}) {
    const auto table = ring_elevations_deg(name);
    ASSERT_TRUE(table);
    EXPECT_EQ(table->size(), count);
    EXPECT_TRUE(std::ranges::is_sorted(*table));
  }
  EXPECT_FALSE(ring_elevations_deg("64"));
}

TEST(Lidar, PointsOfAMovingScanLieOnTheWallsOfTheirFiringTime) {
  const Walk walk = walk_of(20.0);
  const Cell cell = *make_cell("plain_100", 20.0);
  const Pose T_body_lidar = {Eigen::Quaterniond(Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY())),
                             Eigen::Vector3d(0.1, 0.02, 0.15)};
  LidarOptions options = lidar_options("uneven", 100.0);
  options.range_noise = options.outliers = 0.0;
  SpinningLidar lidar(T_body_lidar, options);
  const Time start = from_seconds(walk.far_end() + 2.0);  // while it turns
  const LidarScan scan = lidar.scan(walk, cell.world, start);
  ASSERT_GT(scan.points.size(), 25000u);
  for (const LidarPoint& point : scan.points) {
    const Pose T_world_lidar =
        walk.pose(to_seconds(scan.stamp + point.time_offset_ns)) * T_body_lidar;
    const Eigen::Vector3d p_world = T_world_lidar * point.position.cast<double>();
    const Eigen::Vector3d inside = cell.world.room.max() - p_world;
    const Eigen::Vector3d outside = p_world - cell.world.room.min();
    ASSERT_NEAR(std::min(inside.minCoeff(), outside.minCoeff()), 0.0, 1e-5);
  }
}

TEST(Lidar, RangeHasItsNoiseItsOutliersAndItsLimit) {
  const Walk walk = walk_of(20.0);
  const Cell cell = *make_cell("doors_30", 20.0);
  SpinningLidar lidar(Pose{}, lidar_options("32", 10.0));
  const LidarScan scan = lidar.scan(walk, cell.world, 0);
  const Pose pose = walk.pose(0.0);
  double squares = 0.0;
  double outliers = 0.0;
  for (const LidarPoint& point : scan.points) {
    const Eigen::Vector3d position = point.position.cast<double>();
    const double range = position.norm();
    EXPECT_LT(range, 10.2);
    const double error =
        range - cell.world.distance(pose.translation, pose.rotation * position.normalized());
    if (std::abs(error) > 0.12) ++outliers;
    if (std::abs(error) <= 0.12) squares += error * error;
  }
  const auto count = static_cast<double>(scan.points.size());
  EXPECT_LT(count, 32.0 * 1800.0);
  EXPECT_NEAR(std::sqrt(squares / (count - outliers)), 0.02, 0.001);
  EXPECT_NEAR(outliers / count, 0.002, 0.001);
}

}  // namespace
}  // namespace aims::independent
