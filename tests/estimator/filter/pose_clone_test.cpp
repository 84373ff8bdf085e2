// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/pose_clone.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "core/random.hpp"
#include "estimator/filter/imu_propagation.hpp"
#include "estimator/legs/leg_displacement_model.hpp"
#include "tests/estimator/finite_differences.hpp"

namespace aims {
namespace {

constexpr int kJointSize = ErrorState::kSize + ErrorState::kPoseSize;
constexpr double kStep = 0.1;  ///< between scans [s]
using MatrixJoint = Eigen::Matrix<double, kJointSize, kJointSize>;

const Pose kT_body_base{so3_exp({0.1, -0.2, 0.3}), {0.2, -0.1, -0.05}};
const Eigen::Matrix3d kNoise = 1e-4 * Eigen::Matrix3d::Identity();

ErrorVector normal_error(RandomStream& random) {
  ErrorVector v;
  for (int i = 0; i < ErrorState::kSize; ++i) v(i) = random.normal();
  return v;
}

ErrorMatrix some_covariance(RandomStream& random) {
  ErrorMatrix A;
  for (int i = 0; i < ErrorState::kSize; ++i) A.col(i) = 0.02 * normal_error(random);
  return A * A.transpose() + 1e-4 * ErrorMatrix::Identity();
}

InertialSegment segment_at(int step) {
  const Eigen::Vector3d rate(0.3 * std::sin(0.7 * step), 0.2, 0.4);
  const Eigen::Vector3d force(std::cos(0.5 * step), 0.5, 9.81);
  return {0, from_seconds(kStep), rate, force, true};
}

/// What the legs report between two true poses, without noise.
Eigen::Vector3d way(const Pose& T_odom_clone, const NominalState& state) {
  return leg_displacement_model(T_odom_clone, state, kT_body_base, Eigen::Vector3d::Zero(), kNoise)
      .residual;
}

/// The belief after fusing the displacement `measured` since `clone`.
Belief fuse(const Belief& belief, const PoseClone& clone, const Eigen::Vector3d& measured) {
  const ErrorMatrix information = inverse_spd(belief.covariance);
  const RelativeMeasurement relative =
      leg_displacement_model(clone.T_odom_body, belief.state, kT_body_base, measured, kNoise);
  return kalman_update(belief.state, information, belief.state,
                       information_of(marginalise_clone(relative, clone, information)));
}

TEST(PoseClone, GivesTheStateOfTheJointUpdateInGainForm) {
  RandomStream random(1, "clone");
  const ImuPropagationConfig imu;
  Belief belief{test::some_state(), some_covariance(random)};
  PoseClone clone = clone_pose(belief);
  MatrixJoint P;  // state, then clone
  P << belief.covariance, clone.cross_covariance.transpose(), clone.cross_covariance,
      clone.covariance;
  for (int step = 0; step < 3; ++step) {
    MatrixJoint F = MatrixJoint::Identity();
    F.topLeftCorner<ErrorState::kSize, ErrorState::kSize>() =
        propagation_jacobian(belief.state, segment_at(step), kStep);
    clone = propagate_clone(clone, F.topLeftCorner<ErrorState::kSize, ErrorState::kSize>());
    belief = propagate(belief, segment_at(step), kStep, imu);
    P = F * P * F.transpose();
    P.topLeftCorner<ErrorState::kSize, ErrorState::kSize>() += propagation_noise(imu, true, kStep);
  }
  const Eigen::Vector3d measured =
      way(clone.T_odom_body, belief.state) + Eigen::Vector3d(0.02, -0.01, 0.03);
  const RelativeMeasurement m =
      leg_displacement_model(clone.T_odom_body, belief.state, kT_body_base, measured, kNoise);
  Eigen::Matrix<double, 3, kJointSize> H;
  H << m.jacobian, m.clone_jacobian;
  const Eigen::Matrix3d S = H * P * H.transpose() + kNoise;
  const Eigen::Matrix<double, kJointSize, 3> K = P * H.transpose() * S.inverse();
  const ErrorVector delta = -(K * m.residual).head<ErrorState::kSize>();
  const ErrorMatrix G = reset_jacobian(delta);
  const MatrixJoint posterior = (MatrixJoint::Identity() - K * H) * P;

  const Belief updated = fuse(belief, clone, measured);
  EXPECT_LT((boxminus(updated.state, belief.state) - delta).norm(), 1e-9);
  const ErrorMatrix expected =
      G * posterior.topLeftCorner<ErrorState::kSize, ErrorState::kSize>() * G.transpose();
  EXPECT_LT((updated.covariance - expected).cwiseAbs().maxCoeff(), 1e-9);
}

/// The error of the present state as a linear map of everything random: the first error and the
/// noise of each propagation. Along it the displacements are rows, fused all at once.
TEST(PoseClone, ManyUpdatesGiveTheCovarianceOfOneBatch) {
  constexpr int kSteps = 8;
  RandomStream random(2, "clone");
  const ImuPropagationConfig imu;
  Belief belief{test::some_state(), some_covariance(random)};
  constexpr int kRandom = ErrorState::kSize * (kSteps + 1);
  Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(kRandom, kRandom);
  prior.topLeftCorner<ErrorState::kSize, ErrorState::kSize>() = belief.covariance;
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(ErrorState::kSize, kRandom);
  map.leftCols<ErrorState::kSize>().setIdentity();
  Eigen::MatrixXd rows(3 * kSteps, kRandom);
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::MatrixXd clone_map = map.topRows<ErrorState::kPoseSize>();
    const ErrorMatrix F = propagation_jacobian(belief.state, segment_at(step), kStep);
    const PoseClone clone = propagate_clone(clone_pose(belief), F);
    belief = propagate(belief, segment_at(step), kStep, imu);
    const int at = ErrorState::kSize * (step + 1);
    map = F * map;
    map.middleCols<ErrorState::kSize>(at).setIdentity();
    prior.block<ErrorState::kSize, ErrorState::kSize>(at, at) = propagation_noise(imu, true, kStep);
    const Eigen::Vector3d measured = way(clone.T_odom_body, belief.state);
    const RelativeMeasurement m =
        leg_displacement_model(clone.T_odom_body, belief.state, kT_body_base, measured, kNoise);
    rows.middleRows<3>(3 * step) = m.jacobian * map + m.clone_jacobian * clone_map;
    // Without a residual nothing moves: filter and batch are linearised at the same states.
    belief = fuse(belief, clone, measured);
  }
  const Eigen::MatrixXd noise = 1e-4 * Eigen::MatrixXd::Identity(3 * kSteps, 3 * kSteps);
  const Eigen::MatrixXd S = rows * prior * rows.transpose() + noise;
  const Eigen::MatrixXd batch = prior - prior * rows.transpose() * S.llt().solve(rows * prior);
  const Eigen::MatrixXd expected = map * batch * map.transpose();
  EXPECT_LT((belief.covariance - expected).cwiseAbs().maxCoeff(),
            1e-7 * expected.diagonal().maxCoeff());
}

TEST(PoseClone, DisplacementsNeverTellWhereTheRobotIs) {
  const ImuPropagationConfig imu;
  Belief belief{test::some_state(), 1e-2 * ErrorMatrix::Identity()};
  for (int step = 0; step < 50; ++step) {
    const ErrorMatrix F = propagation_jacobian(belief.state, segment_at(step), kStep);
    const PoseClone clone = propagate_clone(clone_pose(belief), F);
    belief = propagate(belief, segment_at(step), kStep, imu);
    belief = fuse(belief, clone, way(clone.T_odom_body, belief.state));
  }
  const Eigen::Matrix3d position =
      block(belief.covariance, ErrorState::kPosition, ErrorState::kPosition);
  EXPECT_GT(position.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 1e-2);
}

/// One run of propagation and displacements, with noise drawn from their models; the normalised
/// squared error at the end, chi-square with 21 dof.
double normalised_error_of_a_run(std::uint64_t seed) {
  RandomStream random(seed, "clone.nees");
  const ImuPropagationConfig imu;
  Belief belief{test::some_state(), 1e-4 * ErrorMatrix::Identity()};
  NominalState truth = boxplus(belief.state, 1e-2 * normal_error(random));
  for (int step = 0; step < 40; ++step) {
    const PoseClone born = clone_pose(belief);
    const Pose true_clone = truth.T_odom_body();
    const InertialSegment measured = segment_at(step);
    truth = propagate_state(truth, measured, kStep, imu.gravity);
    const ErrorMatrix Q = propagation_noise(imu, true, kStep);
    truth = boxplus(truth, test::square_root(Q) * normal_error(random));
    const ErrorMatrix F = propagation_jacobian(belief.state, measured, kStep);
    const PoseClone clone = propagate_clone(born, F);
    belief = propagate(belief, measured, kStep, imu);
    belief = fuse(belief, clone, way(true_clone, truth) + 1e-2 * random.normal3());
  }
  const ErrorVector error = boxminus(truth, belief.state);
  return error.dot(belief.covariance.llt().solve(error));
}

TEST(PoseClone, NormalisedErrorLiesWithinItsChiSquareBounds) {
  double sum = 0.0;
  for (int run = 0; run < 50; ++run) {
    sum += normalised_error_of_a_run(static_cast<std::uint64_t>(200 + run));
  }
  // The sum is chi-square with 1050 dof: 99.9 % of it lies within these bounds.
  EXPECT_GT(sum, 905.0) << "seeds 200 to 249";
  EXPECT_LT(sum, 1208.0) << "seeds 200 to 249";
}

}  // namespace
}  // namespace aims
