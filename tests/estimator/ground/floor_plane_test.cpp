// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/ground/floor_plane.hpp"

#include <gtest/gtest.h>

#include "tests/estimator/ground/floor_scene.hpp"

namespace aims {
namespace {

using test::FloorScene;

constexpr double kHeight = 0.32;

Pose body_at(double x, double z, double pitch = 0.0, double roll = 0.0) {
  return {so3_exp({0.0, pitch, 0.0}) * so3_exp({roll, 0.0, 0.0}), {x, 0.0, z}};
}

std::optional<FloorPlane> see(const FloorScene& scene, const Pose& T_world_body, int seed = 1) {
  RandomStream random(static_cast<std::uint64_t>(seed), "floor");
  return fit_floor(test::scan_floor(scene, T_world_body, random), FloorConfig{});
}

/// Roll and pitch error [rad] of the normal against the vertical.
Eigen::Vector2d tilt_error(const FloorPlane& floor, const Pose& T_world_body) {
  return (T_world_body.rotation * floor.normal).head<2>();
}

TEST(FloorPlane, FindsALevelFloorUnderATiltedTrunk) {
  const Pose pose = body_at(0.0, kHeight, 0.02, -0.015);
  const auto floor = see({}, pose);
  ASSERT_TRUE(floor.has_value());
  EXPECT_LT(tilt_error(*floor, pose).norm(), 2e-3);
  EXPECT_NEAR(floor->height, kHeight, 3e-3);
  EXPECT_LT(floor->bend, 0.01);
}

TEST(FloorPlane, NormalErrorsMatchTheirCovariance) {
  const Pose pose = body_at(0.0, kHeight, 0.01, 0.01);
  constexpr int kRuns = 40;
  double sum = 0.0;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const auto floor = see({}, pose, seed);
    ASSERT_TRUE(floor.has_value());
    const Eigen::Vector2d error = tilt_error(*floor, pose);
    const Eigen::Matrix3d R = pose.R();
    const Eigen::Matrix3d covariance = R * floor->normal_covariance * R.transpose();
    sum += error.dot(covariance.topLeftCorner<2, 2>().inverse() * error);
  }
  // Two degrees of freedom: 2 on average, deviation 2 / sqrt(runs).
  EXPECT_GT(sum / kRuns, 0.8);
  EXPECT_LT(sum / kRuns, 3.2);
}

TEST(FloorPlane, BumpsOfTwoCentimetresTiltItByLittle) {
  FloorScene scene;
  scene.height = [](double x, double y) {
    return 0.01 * std::sin(7.0 * x + 1.0) * std::sin(6.0 * y + 2.0);
  };
  const Pose pose = body_at(0.0, kHeight);
  const auto floor = see(scene, pose);
  ASSERT_TRUE(floor.has_value());
  EXPECT_LT(tilt_error(*floor, pose).norm(), 3e-3);
  EXPECT_NEAR(floor->height, kHeight, 8e-3);
  EXPECT_LT(floor->bend, FloorConfig{}.bend);
}

TEST(FloorPlane, FurnitureAlongOneSideDoesNotTiltIt) {
  FloorScene scene;  // Low and high boxes along the left wall, and a rear end wall.
  scene.height = [](double x, double y) {
    if (x < -2.2) return 3.0;
    if (y > 0.7 && x > 1.8 && x < 2.4) return 0.25;
    return y > 0.6 && x > 3.0 ? 1.0 : 0.0;
  };
  const Pose pose = body_at(0.0, kHeight);
  const auto floor = see(scene, pose);
  ASSERT_TRUE(floor.has_value());
  EXPECT_LT(tilt_error(*floor, pose).norm(), 3e-3);
  EXPECT_NEAR(floor->height, kHeight, 4e-3);
}

TEST(FloorPlane, IsNotSeenAcrossAPit) {
  FloorScene scene;
  scene.height = [](double, double) { return -3.0; };
  EXPECT_FALSE(see(scene, body_at(0.0, kHeight)).has_value());
  EXPECT_FALSE(fit_floor({}, FloorConfig{}).has_value());
}

TEST(FloorPlane, ARampAheadBendsOrTiltsIt) {
  FloorScene scene;
  scene.height = [](double x, double) { return test::ramp_height(x, 2.0, 8.0, 0.06); };
  const FloorConfig config;
  for (const double x : {-0.5, 0.0, 0.5, 1.0, 2.0}) {
    const Pose pose = body_at(x, scene.height(x, 0.0) + kHeight);
    const auto floor = see(scene, pose);
    if (!floor) continue;  // too uneven for a plane
    EXPECT_TRUE(floor->bend > config.bend || tilt_error(*floor, pose).norm() > config.tilt) << x;
  }
}

TEST(FloorPlane, AStepAheadDoesNotTiltTheFloorBeforeIt) {
  FloorScene scene;
  scene.height = [](double x, double) { return x > 3.0 ? 0.17 : 0.0; };
  const Pose pose = body_at(0.0, kHeight);
  const auto floor = see(scene, pose);
  ASSERT_TRUE(floor.has_value());
  EXPECT_LT(tilt_error(*floor, pose).norm(), 3e-3);
  EXPECT_NEAR(floor->height, kHeight, 4e-3);
}

}  // namespace
}  // namespace aims
