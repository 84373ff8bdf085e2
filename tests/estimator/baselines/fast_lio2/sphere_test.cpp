// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/state.hpp"

#include <gtest/gtest.h>

#include <random>

namespace aims::fast_lio2 {
namespace {

constexpr unsigned kSeed = 7;

Eigen::Vector3d random_vector(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return {normal(random), normal(random), normal(random)};
}

TEST(FastLio2Sphere, BasisIsOrthonormalAndPerpendicular) {
  std::mt19937 random(kSeed);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d g = 9.81 * random_vector(random).normalized();
    const Matrix32 B = sphere_basis(g);
    EXPECT_TRUE((B.transpose() * B).isIdentity(1e-12)) << "seed " << kSeed << ", case " << i;
    EXPECT_LT((B.transpose() * g).norm(), 1e-11);
  }
  EXPECT_LT((sphere_basis({-2.0, 0.0, 0.0}).transpose() * Eigen::Vector3d::UnitX()).norm(), 1e-12);
}

TEST(FastLio2Sphere, PlusKeepsTheLengthAndMinusUndoesIt) {
  std::mt19937 random(kSeed);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d g = 9.81 * random_vector(random).normalized();
    const Eigen::Vector2d u = random_vector(random).head<2>();
    const Eigen::Vector3d moved = sphere_plus(g, u);
    EXPECT_NEAR(moved.norm(), 9.81, 1e-12);
    EXPECT_TRUE(sphere_minus(moved, g).isApprox(u, 1e-9)) << "seed " << kSeed << ", case " << i;
    EXPECT_TRUE(sphere_plus(g, sphere_minus(moved, g)).isApprox(moved, 1e-12));
  }
}

TEST(FastLio2Sphere, MinusOfEqualAndOppositeVectorsIsDefined) {
  const Eigen::Vector3d g(1.0, -2.0, 0.5);
  EXPECT_EQ(sphere_minus(g, g), Eigen::Vector2d::Zero());
  EXPECT_TRUE(sphere_plus(g, sphere_minus(-g, g)).isApprox(-g, 1e-12));
}

TEST(FastLio2Sphere, JacobiansMatchFiniteDifferences) {
  constexpr double kStep = 1e-6;
  std::mt19937 random(kSeed);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d g = 9.81 * random_vector(random).normalized();
    const Eigen::Vector2d u = 0.5 * random_vector(random).head<2>();
    const Matrix32 plus_jacobian = sphere_plus_jacobian(g, u);
    const Matrix23 minus_jacobian = sphere_minus_jacobian(g);
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(k);
      const Eigen::Vector3d slope =
          (sphere_plus(g, u + step) - sphere_plus(g, u - step)) / (2.0 * kStep);
      EXPECT_LT((plus_jacobian.col(k) - slope).norm(), 1e-7) << "seed " << kSeed;
    }
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
      const Eigen::Vector2d slope =
          (sphere_minus(g + step, g) - sphere_minus(g - step, g)) / (2.0 * kStep);
      EXPECT_LT((minus_jacobian.col(k) - slope).norm(), 1e-7) << "seed " << kSeed;
    }
  }
}

}  // namespace
}  // namespace aims::fast_lio2
