// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/feature_solver.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "tests/estimator/baselines/room_scan.hpp"

namespace aims::features {
namespace {

using aims::testing::pose_of;
using aims::testing::position_error;
using aims::testing::rotation_error;

/// Points of a scan at `T_target_scan` on planes through the origin's surroundings with the given
/// normals, and on a few lines along `line_directions`.
FeatureMatches matches_at(const Pose& T_target_scan, const std::vector<Eigen::Vector3d>& normals,
                          const std::vector<Eigen::Vector3d>& line_directions = {}) {
  RandomStream random(1, "matches");
  FeatureMatches matches;
  const Pose T_scan_target = T_target_scan.inverse();
  for (const Eigen::Vector3d& normal : normals) {
    for (int i = 0; i < 40; ++i) {
      Eigen::Vector3d on_plane = 3.0 * random.normal3();
      on_plane += (2.0 - normal.dot(on_plane)) * normal;
      matches.planes.push_back({T_scan_target * on_plane, 1.0, normal, -2.0});
    }
  }
  for (const Eigen::Vector3d& direction : line_directions) {
    const Eigen::Vector3d origin = 3.0 * random.normal3();
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d on_line = origin + random.normal() * direction;
      matches.lines.push_back({T_scan_target * on_line, 1.0, origin, direction});
    }
  }
  return matches;
}

const std::vector<Eigen::Vector3d> kRoom = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(),
                                            Eigen::Vector3d::UnitZ()};
const std::vector<Eigen::Vector3d> kCorridor = {Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
const Pose kTruth = pose_of({0.08, -0.05, 0.03}, {0.01, -0.02, 0.015});

SolverConfig full_steps() {
  SolverConfig config;
  config.residual_factor = 1.0;
  config.stop_position = 1e-9;
  config.stop_rotation_deg = 1e-7;
  return config;
}

SolverConfig damped() {
  SolverConfig config;
  config.method = SolverMethod::kLevenbergMarquardt;
  config.max_iterations = 8;
  config.association_interval = 4;
  return config;
}

Associate fixed(const FeatureMatches& matches) {
  return [&matches](const Pose&) { return matches; };
}

TEST(DistanceRow, JacobianMatchesFiniteDifferences) {
  constexpr double kStep = 1e-6;
  const FeatureMatches matches =
      matches_at(kTruth, kRoom, {Eigen::Vector3d(1, 2, -1).normalized()});
  const Pose pose = pose_of({0.2, 0.1, -0.1}, {0.1, 0.2, -0.1});
  const auto check = [&](const auto& match) {
    const Vector6 jacobian = distance_row(match, pose).jacobian();
    for (int i = 0; i < 6; ++i) {
      const Vector6 step = kStep * Vector6::Unit(i);
      const double slope = (distance_row(match, moved(pose, step)).distance -
                            distance_row(match, moved(pose, -step)).distance) /
                           (2.0 * kStep);
      EXPECT_NEAR(jacobian[i], slope, 1e-5);
    }
  };
  for (const PlaneMatch& match : matches.planes) check(match);
  for (const LineMatch& match : matches.lines) check(match);
}

TEST(DistanceRow, IsThatOfThePartOfTheMotion) {
  const Pose motion = pose_of({0.4, 0.0, 0.0}, {0.0, 0.0, 0.2});
  const PlaneMatch match{{1.0, 0.0, 0.0}, 0.5, Eigen::Vector3d::UnitX(), 0.0};
  EXPECT_NEAR(distance_row(match, motion).distance, std::cos(0.1) + 0.2, 1e-12);
}

TEST(GaussNewton, FindsTheMotionInARoom) {
  const FeatureMatches matches = matches_at(kTruth, kRoom);
  const SolverResult result = solve_pose(Pose(), fixed(matches), full_steps());
  EXPECT_LT(position_error(result.pose, kTruth), 1e-6);
  EXPECT_LT(rotation_error(result.pose, kTruth), 1e-6);
  EXPECT_EQ(result.directions.removed, 0);
}

TEST(GaussNewton, TheResidualFactorLeavesAPartOfTheMotion) {
  const Pose truth = pose_of({0.08, -0.05, 0.03}, Eigen::Vector3d::Zero());
  const FeatureMatches matches = matches_at(truth, kRoom);
  SolverConfig config = full_steps();
  config.residual_factor = 0.05;
  config.unweighted_iterations = config.max_iterations;
  const SolverResult result = solve_pose(Pose(), fixed(matches), config);
  const double part = 1.0 - std::pow(0.95, config.max_iterations);
  EXPECT_EQ(result.iterations, 25);
  EXPECT_LT(position_error(result.pose, Pose{truth.rotation, part * truth.translation}), 1e-9);
}

TEST(GaussNewton, ADegenerateDirectionKeepsItsInitialValue) {
  const FeatureMatches matches = matches_at(kTruth, kCorridor);
  const Pose initial = pose_of({0.5, 0.0, 0.0}, Eigen::Vector3d::Zero());
  const SolverResult result = solve_pose(initial, fixed(matches), full_steps());
  EXPECT_EQ(result.directions.removed, 1);
  EXPECT_LT(result.directions.smallest_eigenvalue, 1e-6);
  EXPECT_NEAR(result.pose.translation.x(), 0.5, 1e-6);
  EXPECT_NEAR(result.pose.translation.y(), kTruth.translation.y(), 1e-2);
  EXPECT_LT(rotation_error(result.pose, kTruth), 1e-3);
}

TEST(GaussNewton, WhatNoiseSeemsToConstrainDoesNotMove) {
  const Pose truth = pose_of({0.0, -0.05, 0.03}, Eigen::Vector3d::Zero());
  FeatureMatches matches = matches_at(truth, kCorridor);
  RandomStream random(4, "normals");
  for (PlaneMatch& match : matches.planes) {
    const Eigen::Vector3d on_plane = truth * match.point;
    match.normal = (match.normal + 0.02 * random.normal3()).normalized();
    match.offset = -match.normal.dot(on_plane);
  }
  const Pose initial = pose_of({0.5, 0.0, 0.0}, Eigen::Vector3d::Zero());
  SolverConfig config = full_steps();
  EXPECT_NEAR(solve_pose(initial, fixed(matches), config).pose.translation.x(), 0.5, 0.02);
  config.remap_threshold = 0.0;
  EXPECT_LT(solve_pose(initial, fixed(matches), config).pose.translation.x(), 0.1) << "seed 4";
}

TEST(GaussNewton, FartherPointsWeighLessAfterTheFirstIterations) {
  const Pose initial = pose_of({1e-3, -1e-3, 1e-3}, Eigen::Vector3d::Zero());
  FeatureMatches matches = matches_at(Pose(), kRoom);
  PlaneMatch outlier = matches.planes.front();
  outlier.offset -= 5.0;
  matches.planes.push_back(outlier);
  SolverConfig config = full_steps();
  config.unweighted_iterations = 0;
  EXPECT_LT(position_error(solve_pose(initial, fixed(matches), config).pose, Pose()), 1e-9);
  config.max_iterations = config.unweighted_iterations = 5;
  EXPECT_GT(position_error(solve_pose(initial, fixed(matches), config).pose, Pose()), 1e-2);
}

TEST(GaussNewton, TooFewMatchesLeaveTheInitialPose) {
  FeatureMatches matches = matches_at(kTruth, kRoom);
  matches.planes.resize(9);
  const SolverResult result = solve_pose(kTruth, fixed(matches), full_steps());
  EXPECT_EQ(result.iterations, 0);
  EXPECT_EQ(result.pose.translation, kTruth.translation);
}

TEST(GaussNewton, OnlyTheGivenCoordinatesMove) {
  const FeatureMatches matches = matches_at(kTruth, kRoom);
  const SolverResult result = solve_pose(Pose(), fixed(matches), full_steps(), {0, 1, 5});
  EXPECT_EQ(result.pose.translation.head<2>(), Eigen::Vector2d::Zero());
  EXPECT_GT(std::abs(result.pose.translation.z()), 1e-3);
}

TEST(GaussNewton, AssociatesOnceInEachInterval) {
  const FeatureMatches matches = matches_at(kTruth, kRoom);
  SolverConfig config = full_steps();
  config.residual_factor = 0.05;
  int calls = 0;
  const auto associate = [&](const Pose&) {
    ++calls;
    return matches;
  };
  const SolverResult result = solve_pose(Pose(), associate, config);
  EXPECT_EQ(result.iterations, 25);
  EXPECT_EQ(calls, 5);
}

TEST(LevenbergMarquardt, FindsTheMotionInARoom) {
  const FeatureMatches matches = matches_at(kTruth, kRoom, {Eigen::Vector3d::UnitZ()});
  const SolverResult result = solve_pose(Pose(), fixed(matches), damped());
  EXPECT_LT(position_error(result.pose, kTruth), 1e-6);
  EXPECT_LT(rotation_error(result.pose, kTruth), 1e-6);
}

TEST(LevenbergMarquardt, EndsWhereTheGradientVanishes) {
  FeatureMatches matches = matches_at(kTruth, kRoom, {Eigen::Vector3d::UnitX()});
  RandomStream random(2, "noise");
  for (PlaneMatch& match : matches.planes) match.offset += 0.15 * random.normal();
  const HuberProblem problem(matches, 0.1);
  const Minimum minimum = minimize(problem, Pose(), 100);
  const double least = problem.cost(minimum.pose);
  for (int i = 0; i < 6; ++i) {
    for (const double step : {-1e-3, 1e-3}) {
      EXPECT_LT(least, problem.cost(moved(minimum.pose, step * Vector6::Unit(i)))) << "seed 2";
    }
  }
}

TEST(LevenbergMarquardt, GradientIsThatOfTheCost) {
  constexpr double kStep = 1e-6;
  const FeatureMatches matches = matches_at(kTruth, kRoom, {Eigen::Vector3d::UnitY()});
  const Pose pose = pose_of({0.3, -0.1, 0.05}, {0.05, 0.02, -0.03});
  const HuberProblem problem(matches, 0.1);
  const Vector6 gradient = problem.linearized(pose).gradient;
  for (int i = 0; i < 6; ++i) {
    const Vector6 step = kStep * Vector6::Unit(i);
    const double slope =
        (problem.cost(moved(pose, step)) - problem.cost(moved(pose, -step))) / (2.0 * kStep);
    EXPECT_NEAR(gradient[i], slope, 1e-4 * gradient.norm());
  }
}

TEST(ConstrainedDirections, ProjectsOntoTheEigenvectorsAboveTheThreshold) {
  const Eigen::Matrix3d R = so3_exp({0.3, -0.5, 0.8}).toRotationMatrix();
  const Eigen::Matrix3d AtA = R * Eigen::Vector3d(5.0, 50.0, 500.0).asDiagonal() * R.transpose();
  const ConstrainedDirections directions = constrained_directions(AtA, 10.0);
  EXPECT_EQ(directions.removed, 1);
  EXPECT_NEAR(directions.smallest_eigenvalue, 5.0, 1e-9);
  const Eigen::Vector3d step(1.0, 2.0, 3.0);
  const Eigen::Vector3d in_axes = R.transpose() * (directions.projection * step);
  EXPECT_NEAR(in_axes[0], 0.0, 1e-12);
  EXPECT_NEAR(in_axes[1], R.col(1).dot(step), 1e-12);
  EXPECT_NEAR(in_axes[2], R.col(2).dot(step), 1e-12);
}

}  // namespace
}  // namespace aims::features
