// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/leg_displacement_model.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "estimator/legs/leg_velocity_model.hpp"
#include "tests/estimator/finite_differences.hpp"

namespace aims {
namespace {

const Pose kT_body_base{so3_exp({0.1, -0.2, 0.3}), {0.2, -0.1, -0.05}};
const Eigen::Vector3d kMeasured(0.07, 0.01, -0.02);

/// A state a short way on from some_state(), the clone's.
NominalState later_state() {
  NominalState state = test::some_state();
  state.rotation = state.rotation * so3_exp({0.2, -0.1, 0.3});
  state.position += Eigen::Vector3d(0.3, -0.2, 0.1);
  return state;
}

RelativeMeasurement model(const NominalState& clone, const NominalState& state,
                          const Eigen::Vector3d& measured) {
  return leg_displacement_model(clone.T_odom_body(), state, kT_body_base, measured,
                                Eigen::Matrix3d::Identity());
}

TEST(LegDisplacementModel, JacobianOfTheStateMatchesFiniteDifferences) {
  const NominalState clone = test::some_state();
  const auto numeric = test::numeric_jacobian<3>(later_state(), [&](const NominalState& moved) {
    return model(clone, moved, kMeasured).residual;
  });
  const RelativeMeasurement m = model(clone, later_state(), kMeasured);
  EXPECT_LT((m.jacobian - numeric).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(LegDisplacementModel, JacobianOfTheCloneMatchesFiniteDifferences) {
  const NominalState state = later_state();
  const auto numeric = test::numeric_jacobian<3>(
      test::some_state(),
      [&](const NominalState& moved) { return model(moved, state, kMeasured).residual; });
  const RelativeMeasurement m = model(test::some_state(), state, kMeasured);
  EXPECT_LT((m.clone_jacobian - numeric.leftCols<ErrorState::kPoseSize>()).cwiseAbs().maxCoeff(),
            1e-8);
}

TEST(LegDisplacementModel, ResidualVanishesForTheWayOfTheBase) {
  const NominalState clone = test::some_state();
  const NominalState state = later_state();
  const Pose T_base_base =
      (clone.T_odom_body() * kT_body_base).inverse() * (state.T_odom_body() * kT_body_base);
  EXPECT_LT(model(clone, state, T_base_base.translation).residual.norm(), 1e-12);
}

TEST(LegDisplacementModel, NoiseIsThatOfTheVelocitiesOfTheSamePackets) {
  const LegConfig config;
  const Eigen::Vector3d velocity(0.7, 0.0, 0.0);
  const LegDisplacement all{0.1 * velocity, from_seconds(0.1), 20};
  const Eigen::Matrix3d of_mean_velocity = leg_velocity_noise(config, velocity) / 20.0;
  const Eigen::Matrix3d noise = leg_displacement_noise(config, all);
  EXPECT_LT((noise - 0.1 * 0.1 * of_mean_velocity).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(LegDisplacementModel, NoiseGrowsWithTheSquareRootOfTime) {
  const LegConfig config;
  const LegDisplacement once{{0.07, 0.0, 0.0}, from_seconds(0.1), 20};
  const LegDisplacement four_times{{0.28, 0.0, 0.0}, from_seconds(0.4), 80};
  const Eigen::Matrix3d ratio =
      leg_displacement_noise(config, four_times) * leg_displacement_noise(config, once).inverse();
  EXPECT_LT((ratio - 4.0 * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(LegDisplacementModel, NoiseGrowsWithThePacketsLost) {
  const LegConfig config;
  const LegDisplacement all{{0.07, 0.0, 0.0}, from_seconds(0.1), 20};
  LegDisplacement half = all;
  half.packets = 10;
  EXPECT_NEAR(leg_displacement_noise(config, half)(0, 0),
              2.0 * leg_displacement_noise(config, all)(0, 0), 1e-12);
}

}  // namespace
}  // namespace aims
