// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/preintegration.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/random.hpp"
#include "estimator/baselines/pose_graph/pose_graph.hpp"

namespace aims::lio_sam {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using pose_graph::Linearization;
using pose_graph::pose_prior;
using pose_graph::relative_pose;
using pose_graph::sqrt_information_of;

Pose random_pose(RandomStream& random) {
  return {so3_exp(0.8 * random.normal3()), 2.0 * random.normal3()};
}

/// Compares the derivatives of a factor's model with central differences.
void expect_jacobians(const Factor& factor, const std::vector<Value>& values) {
  constexpr double kSmall = 1e-6;
  const Linearization at = factor.model(values);
  ASSERT_EQ(at.jacobians.size(), values.size());
  for (std::size_t v = 0; v < values.size(); ++v) {
    const int size = dimension_of(values[v]);
    ASSERT_EQ(at.jacobians[v].cols(), size);
    for (int i = 0; i < size; ++i) {
      std::vector<Value> ahead = values;
      std::vector<Value> behind = values;
      ahead[v] = moved(values[v], kSmall * VectorXd::Unit(size, i));
      behind[v] = moved(values[v], -kSmall * VectorXd::Unit(size, i));
      const VectorXd slope =
          (factor.model(ahead).residual - factor.model(behind).residual) / (2.0 * kSmall);
      EXPECT_LT((slope - at.jacobians[v].col(i)).norm(), 1e-6 * (1.0 + slope.norm()))
          << "variable " << v << ", entry " << i;
    }
  }
}

Preintegration some_motion(RandomStream& random) {
  Preintegration motion;
  motion.bias = {0.1 * random.normal3(), 0.01 * random.normal3()};
  for (int i = 0; i < 20; ++i) {
    integrate(motion, random.normal3(), Vector3d(0.0, 0.0, 9.8) + random.normal3(), 0.01, {});
  }
  return motion;
}

TEST(LioSamFactors, JacobiansMatchFiniteDifferences) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    SCOPED_TRACE(seed);
    RandomStream random(seed, "factors_test");
    const MatrixXd W = MatrixXd::Identity(6, 6);
    expect_jacobians(pose_prior(0, random_pose(random), W), {random_pose(random)});
    expect_jacobians(relative_pose(0, 1, random_pose(random), W),
                     {random_pose(random), random_pose(random)});
    expect_jacobians(velocity_prior(0, random.normal3(), MatrixXd::Identity(3, 3)),
                     {Value(Vector3d(random.normal3()))});
    expect_jacobians(bias_prior(0, ImuBias(), W), {ImuBias{random.normal3(), random.normal3()}});
    expect_jacobians(bias_walk(0, 1, W), {ImuBias{random.normal3(), random.normal3()},
                                          ImuBias{random.normal3(), random.normal3()}});
    const auto imu = imu_factor({0, 1, 4}, {2, 3, 5}, some_motion(random), 9.8);
    ASSERT_TRUE(imu);
    expect_jacobians(*imu, {random_pose(random), Vector3d(random.normal3()), random_pose(random),
                            Vector3d(random.normal3()),
                            ImuBias{0.1 * random.normal3(), 0.05 * random.normal3()}});
  }
}

TEST(LioSamFactors, AMotionThatThePredictionFulfilsHasNoResidual) {
  RandomStream random(9, "factors_test");
  const Preintegration motion = some_motion(random);
  const NavState from{random_pose(random), random.normal3()};
  const NavState to = predicted(from, motion, motion.bias, 9.8);
  const auto factor = imu_factor({0, 1, 4}, {2, 3, 5}, motion, 9.8);
  ASSERT_TRUE(factor);
  const std::vector<Value> values = {from.T_map_imu, from.velocity, to.T_map_imu, to.velocity,
                                     motion.bias};
  EXPECT_LT(factor->model(values).residual.norm(), 1e-9);
}

TEST(LioSamFactors, AMotionWithoutSamplesHasNoFactor) {
  EXPECT_FALSE(imu_factor({0, 1, 4}, {2, 3, 5}, Preintegration(), 9.8));
}

TEST(LioSamFactors, TheSquareRootOfTheInformationWhitens) {
  RandomStream random(2, "factors_test");
  const Preintegration motion = some_motion(random);
  const auto W = sqrt_information_of(motion.covariance);
  ASSERT_TRUE(W);
  EXPECT_LT((*W * motion.covariance * W->transpose() - MatrixXd::Identity(9, 9)).norm(), 1e-8);
  EXPECT_FALSE(sqrt_information_of(MatrixXd::Zero(3, 3)));
}

}  // namespace
}  // namespace aims::lio_sam
