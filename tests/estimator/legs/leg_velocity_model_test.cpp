// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/leg_velocity_model.hpp"

#include <gtest/gtest.h>

#include "tests/estimator/finite_differences.hpp"

namespace aims {
namespace {

const Pose kT_body_base{so3_exp({0.1, -0.2, 0.3}), {0.2, -0.1, -0.05}};
const Eigen::Vector3d kRate(0.7, -0.4, 0.9);

TEST(LegVelocity, JacobianMatchesFiniteDifferences) {
  const Eigen::Vector3d mean(0.5, 0.2, -0.3);
  const LegVelocity measured{{0.6, 0.1, -0.1}, mean, mean};
  const Eigen::Matrix3d noise = Eigen::Matrix3d::Identity();
  const NominalState state = test::some_state();
  const auto numeric = test::numeric_jacobian<3>(state, [&](const NominalState& moved) {
    return leg_velocity_model(moved, kT_body_base, kRate, measured, noise).residual;
  });
  const LinearMeasurement m = leg_velocity_model(state, kT_body_base, kRate, measured, noise);
  EXPECT_LT((m.jacobian - numeric).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(LegVelocity, ResidualIsZeroForARigidBody) {
  const NominalState state = test::some_state();
  const Eigen::Vector3d rate = kRate - state.gyro_bias;
  const Eigen::Vector3d of_base_in_odom =
      state.velocity + state.rotation * rate.cross(kT_body_base.translation);
  const Eigen::Vector3d of_base =
      (state.rotation * kT_body_base.rotation).conjugate() * of_base_in_odom;
  const Eigen::Vector3d mean(0.5, 0.2, -0.3);
  const LegVelocity measured{of_base + state.leg_scale.cwiseProduct(mean) + state.leg_bias, mean,
                             mean};
  const LinearMeasurement m =
      leg_velocity_model(state, kT_body_base, kRate, measured, Eigen::Matrix3d::Identity());
  EXPECT_LT(m.residual.norm(), 1e-12);
}

TEST(LegVelocity, NoiseGrowsByTheCorrelatedSamples) {
  LegConfig config;
  config.velocity_sigma = {0.1, 0.2, 0.3};
  config.scale_sigma = 0.0;
  const Eigen::Matrix3d noise = leg_velocity_noise(config, 200.0, 1.0);
  EXPECT_NEAR(noise(0, 0), 40.0 * 0.01, 1e-12);
  EXPECT_NEAR(noise(2, 2), 40.0 * 0.09, 1e-12);
}

}  // namespace
}  // namespace aims
