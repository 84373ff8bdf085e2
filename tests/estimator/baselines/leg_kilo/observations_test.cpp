// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/leg_kilo/observations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/estimator/baselines/leg_kilo/random_states.hpp"

namespace aims::leg_kilo {
namespace {

constexpr unsigned kSeed = 7;
constexpr double kStep = 1e-6;

TEST(LegKiloObservations, InertialAndFootJacobiansMatchFiniteDifferences) {
  std::mt19937 random(kSeed);
  for (int i = 0; i < 10; ++i) {
    const State x = test::random_state(random);
    const Inertial reading{test::random_vector(random, 5.0), test::random_vector(random, 1.0)};
    const std::vector<StandingFoot> feet = {
        {test::random_vector(random, 0.3), test::random_vector(random, 1.0)},
        {test::random_vector(random, 0.3), test::random_vector(random, 1.0)}};
    const auto innovation = [&](const State& at) {
      return inertial_observation(at, reading, feet, ImuVariances(), 0.1).innovation;
    };
    const Observation rows = inertial_observation(x, reading, feet, ImuVariances(), 0.1);
    ASSERT_EQ(rows.innovation.size(), 12);
    for (int k = 0; k < Error::kSize; ++k) {
      const ErrorVector step = kStep * ErrorVector::Unit(k);
      const Eigen::VectorXd slope =
          (innovation(plus(x, step)) - innovation(plus(x, -step))) / (2.0 * kStep);
      EXPECT_LT((rows.jacobian.col(k) + slope).norm(), 1e-7) << "seed " << kSeed << ", " << k;
    }
  }
}

TEST(LegKiloObservations, TheVerticalForceAndTheFeetHaveTheirOwnVariances) {
  const std::vector<StandingFoot> feet(1);
  const Observation rows = inertial_observation(
      State(), Inertial(), feet, {.force = 0.1, .vertical_force = 1.0, .rate = 0.01}, 0.2);
  Eigen::VectorXd expected(9);
  expected << 0.1, 0.1, 1.0, 0.01, 0.01, 0.01, 0.2, 0.2, 0.2;
  EXPECT_EQ(rows.variance, expected);
}

TEST(LegKiloObservations, PointJacobianMatchesFiniteDifferences) {
  std::mt19937 random(kSeed);
  for (int i = 0; i < 10; ++i) {
    const State x = test::random_state(random);
    const Eigen::Vector3d normal = test::random_vector(random, 1.0).normalized();
    const Eigen::Vector3d in_body = test::random_vector(random, 4.0);
    const Eigen::Vector3d on_plane = test::random_vector(random, 4.0);
    const auto distance = [&](const State& at) {
      return normal.dot(at.T_world_body * in_body - on_plane);
    };
    const std::vector<PointOnPlane> points = {{in_body, normal, distance(x), 0.02}};
    const PoseObservation row = point_observation(x, points, 10.0);
    EXPECT_EQ(row.innovation(0), -distance(x));
    EXPECT_DOUBLE_EQ(row.variance(0), 0.2);
    for (int k = 0; k < Error::kPose; ++k) {
      const ErrorVector step = kStep * ErrorVector::Unit(k);
      const double slope = (distance(plus(x, step)) - distance(plus(x, -step))) / (2.0 * kStep);
      EXPECT_NEAR(row.jacobian(0, k), slope, 1e-7) << "seed " << kSeed << ", " << k;
    }
  }
}

TEST(LegKiloObservations, CovarianceOfAPointIsThatOfManyDraws) {
  constexpr int kDraws = 40000;
  std::mt19937 random(kSeed);
  std::normal_distribution<double> normal;
  const PointNoise noise{.range_sigma = 0.04, .beam_sigma_deg = 0.2};
  Belief belief{test::random_state(random), ErrorMatrix::Zero()};
  const Eigen::Vector3d rotation_sigma(0.004, 0.002, 0.003);
  const Eigen::Vector3d position_sigma(0.02, 0.01, 0.03);
  belief.covariance.diagonal().segment<3>(Error::kRotation) = rotation_sigma.cwiseAbs2();
  belief.covariance.diagonal().segment<3>(Error::kPosition) = position_sigma.cwiseAbs2();
  const Pose T_body_lidar{so3_exp({0.1, -0.2, 0.3}), {0.2, 0.1, 0.4}};
  const Eigen::Vector3d p_lidar(6.0, -3.0, 1.0);
  const ScanPoint point = scan_point(p_lidar, T_body_lidar, belief, noise);
  EXPECT_LT((point.in_world - belief.state.T_world_body * (T_body_lidar * p_lidar)).norm(), 1e-12);

  const Eigen::Vector3d across = p_lidar.unitOrthogonal();
  const Eigen::Vector3d up = p_lidar.normalized().cross(across);
  const double beam_sigma = noise.beam_sigma_deg * std::numbers::pi / 180.0;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int i = 0; i < kDraws; ++i) {
    const double range = p_lidar.norm() + noise.range_sigma * normal(random);
    const Eigen::Vector3d tilt = beam_sigma * (normal(random) * across + normal(random) * up);
    const Eigen::Vector3d drawn = range * (p_lidar.normalized() + tilt).normalized();
    ErrorVector error = ErrorVector::Zero();
    for (int k = 0; k < 3; ++k) {
      error(Error::kRotation + k) = rotation_sigma(k) * normal(random);
      error(Error::kPosition + k) = position_sigma(k) * normal(random);
    }
    const Eigen::Vector3d offset =
        plus(belief.state, error).T_world_body * (T_body_lidar * drawn) - point.in_world;
    sum += offset * offset.transpose() / kDraws;
  }
  EXPECT_LT((point.covariance - sum).norm(), 0.03 * sum.norm()) << "seed " << kSeed;
  EXPECT_LT(point.beam_covariance.trace(), point.covariance.trace());
}

}  // namespace
}  // namespace aims::leg_kilo
