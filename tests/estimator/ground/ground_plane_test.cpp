// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/ground/ground_plane.hpp"

#include <gtest/gtest.h>

#include "tests/estimator/ground/ground_scene.hpp"

namespace aims {
namespace {

using test::GroundScene;

constexpr double kHeight = 0.32;

Pose body_at(double x, double z, double pitch = 0.0, double roll = 0.0) {
  return {so3_exp({0.0, pitch, 0.0}) * so3_exp({roll, 0.0, 0.0}), {x, 0.0, z}};
}

std::optional<GroundPlane> fit(const GroundScene& scene, const Pose& T_world_body, int seed = 1) {
  RandomStream random(static_cast<std::uint64_t>(seed), "floor");
  GroundLists lists;
  return fit_ground(test::scan_ground(scene, T_world_body, random), lists);
}

/// Roll and pitch error [rad] of the normal against the vertical.
Eigen::Vector2d tilt_error(const GroundPlane& plane, const Pose& T_world_body) {
  return (T_world_body.rotation * plane.normal).head<2>();
}

TEST(GroundPlane, FindsLevelGroundUnderATiltedBody) {
  const Pose pose = body_at(0.0, kHeight, 0.02, -0.015);
  const auto plane = fit({}, pose);
  ASSERT_TRUE(plane.has_value());
  EXPECT_LT(tilt_error(*plane, pose).norm(), 2e-3);
  EXPECT_NEAR(plane->height, kHeight, 3e-3);
  EXPECT_LT(plane->bend, 0.01);
}

TEST(GroundPlane, NormalErrorsMatchTheirCovariance) {
  const Pose pose = body_at(0.0, kHeight, 0.01, 0.01);
  constexpr int kRuns = 40;
  double sum = 0.0;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const auto plane = fit({}, pose, seed);
    ASSERT_TRUE(plane.has_value());
    const Eigen::Vector2d error = tilt_error(*plane, pose);
    const Eigen::Matrix3d R = pose.R();
    const Eigen::Matrix3d covariance = R * plane->normal_covariance * R.transpose();
    sum += error.dot(covariance.topLeftCorner<2, 2>().inverse() * error);
  }
  // Two degrees of freedom: 2 on average, deviation 2 / sqrt(runs).
  EXPECT_GT(sum / kRuns, 0.8);
  EXPECT_LT(sum / kRuns, 3.2);
}

TEST(GroundPlane, BumpsOfTwoCentimetresTiltItLittle) {
  GroundScene scene;
  scene.height = [](double x, double y) {
    return 0.01 * std::sin(7.0 * x + 1.0) * std::sin(6.0 * y + 2.0);
  };
  const Pose pose = body_at(0.0, kHeight);
  const auto plane = fit(scene, pose);
  ASSERT_TRUE(plane.has_value());
  EXPECT_LT(tilt_error(*plane, pose).norm(), 3e-3);
  EXPECT_NEAR(plane->height, kHeight, 8e-3);
  EXPECT_LT(plane->bend, 0.02);
}

TEST(GroundPlane, FurnitureAlongOneSideDoesNotTiltIt) {
  GroundScene scene;  // Low and high boxes along the left wall, and a rear end wall.
  scene.height = [](double x, double y) {
    if (x < -2.2) return 3.0;
    if (y > 0.7 && x > 1.8 && x < 2.4) return 0.25;
    return y > 0.6 && x > 3.0 ? 1.0 : 0.0;
  };
  const Pose pose = body_at(0.0, kHeight);
  const auto plane = fit(scene, pose);
  ASSERT_TRUE(plane.has_value());
  EXPECT_LT(tilt_error(*plane, pose).norm(), 3e-3);
  EXPECT_NEAR(plane->height, kHeight, 4e-3);
}

TEST(GroundPlane, IsNotFoundInAPit) {
  GroundScene scene;
  scene.height = [](double, double) { return -3.0; };
  EXPECT_FALSE(fit(scene, body_at(0.0, kHeight)).has_value());
  GroundLists lists;
  EXPECT_FALSE(fit_ground({}, lists).has_value());
}

TEST(GroundPlane, ARampAheadBendsOrTiltsIt) {
  GroundScene scene;
  scene.height = [](double x, double) { return test::ramp_height(x, 2.0, 8.0, 0.06); };
  for (const double x : {-0.5, 0.0, 0.5, 1.0, 2.0}) {
    const Pose pose = body_at(x, scene.height(x, 0.0) + kHeight);
    const auto plane = fit(scene, pose);
    if (!plane) continue;  // too uneven for a plane
    EXPECT_TRUE(plane->bend > 0.02 || tilt_error(*plane, pose).norm() > 7.5e-3) << x;
  }
}

TEST(GroundPlane, AStepAheadDoesNotTiltTheGroundBeforeIt) {
  GroundScene scene;
  scene.height = [](double x, double) { return x > 3.0 ? 0.17 : 0.0; };
  const Pose pose = body_at(0.0, kHeight);
  const auto plane = fit(scene, pose);
  ASSERT_TRUE(plane.has_value());
  EXPECT_LT(tilt_error(*plane, pose).norm(), 3e-3);
  EXPECT_NEAR(plane->height, kHeight, 4e-3);
}

}  // namespace
}  // namespace aims
