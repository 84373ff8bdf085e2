// SPDX-License-Identifier: BSD-3-Clause
// The update under equalities against dense solutions of the same problem.
#include "estimator/constrained/constrained_step.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>

#include "tests/estimator/constrained/synthetic_scans.hpp"
#include "tests/estimator/finite_differences.hpp"

namespace aims {
namespace {

using E = ErrorState;

/// A scan that constrains five of six directions, and depends on mount and delay.
PoseMeasurement some_scan(RandomStream& random) {
  PoseMeasurement scan;
  for (int i = 0; i < 5; ++i) {
    Vector6 row;
    for (double& entry : row) entry = 30.0 * random.normal();
    scan.matrix += row * row.transpose();
    scan.vector += 0.02 * random.normal() * row;
  }
  for (double& entry : scan.jacobian.rightCols<4>().reshaped()) entry = 0.3 * random.normal();
  return scan;
}

/// Two equalities: of the position and of the rotation.
PoseConstraints some_constraints() {
  PoseConstraints constraints;
  PoseConstraint position;
  position.direction << 0.0, 0.0, 0.0, 0.8, 0.6, 0.0;
  PoseConstraint rotation;
  rotation.direction << 0.0, 0.6, 0.8, 0.0, 0.0, 0.0;
  rotation.value = 0.002;
  rotation.measured = true;
  constraints.equal = {position, rotation};
  return constraints;
}

/// C of C x = c over the whole error state.
Eigen::MatrixXd rows_of(const PoseConstraints& constraints) {
  Eigen::MatrixXd C =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(constraints.equal.size()), ErrorState::kSize);
  for (Eigen::Index i = 0; i < C.rows(); ++i) {
    C.row(i).head<6>() = constraints.equal[static_cast<std::size_t>(i)].direction.transpose();
  }
  return C;
}

Eigen::VectorXd values_of(const PoseConstraints& constraints) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(constraints.equal.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values(i) = constraints.equal[static_cast<std::size_t>(i)].value;
  }
  return values;
}

struct Problem {
  RandomStream random{11, "constrained_step.test"};
  Belief prior = test::vague_belief(random);
  PoseMeasurement scan = some_scan(random);
  ErrorMatrix hessian =
      prior.covariance.inverse() + scan.jacobian.transpose() * scan.matrix * scan.jacobian;
  ErrorVector gradient = scan.jacobian.transpose() * scan.vector;

  Belief fused(const PoseConstraints& constraints) const {
    return constrained_step(prior, prior.state, {scan, {}}, constraints);
  }
  ErrorVector step(const PoseConstraints& constraints) const {
    return boxminus(fused(constraints).state, prior.state);
  }
};

TEST(ConstrainedStep, WithoutConstraintsItIsThePlainUpdate) {
  const Problem problem;
  NominalState elsewhere = problem.prior.state;
  elsewhere.position += Eigen::Vector3d(0.05, -0.03, 0.02);
  elsewhere.rotation = so3_exp({0.01, -0.02, 0.015}) * elsewhere.rotation;
  for (const bool legs : {true, false}) {
    const GainMask mask{.legs = legs};
    const Belief plain = fuse(problem.prior, elsewhere, problem.scan, mask);
    const Belief step = constrained_step(problem.prior, elsewhere, {problem.scan, mask}, {});
    EXPECT_LT(boxminus(step.state, plain.state).norm(), 1e-9) << legs;
    EXPECT_LT((step.covariance - plain.covariance).norm(), 1e-9 * plain.covariance.norm());
  }
}

TEST(ConstrainedStep, SolvesTheKktSystem) {
  const Problem problem;
  const PoseConstraints constraints = some_constraints();
  const Eigen::MatrixXd C = rows_of(constraints);
  const Eigen::Index n = ErrorState::kSize;
  Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(n + C.rows(), n + C.rows());
  kkt.topLeftCorner(n, n) = problem.hessian;
  kkt.bottomLeftCorner(C.rows(), n) = C;
  kkt.topRightCorner(n, C.rows()) = C.transpose();
  Eigen::VectorXd right(n + C.rows());
  right << -problem.gradient, values_of(constraints);
  const Eigen::VectorXd solution = kkt.fullPivLu().solve(right);
  EXPECT_LT((problem.step(constraints) - solution.head(n)).norm(), 1e-7 * solution.head(n).norm());
}

// x = x_0 + Z y with C x_0 = c and C Z = 0: the least squares over y alone.
TEST(ConstrainedStep, OtherDirectionsSolveTheReducedProblem) {
  const Problem problem;
  const PoseConstraints constraints = some_constraints();
  const Eigen::MatrixXd C = rows_of(constraints);
  const Eigen::VectorXd x_0 =
      C.transpose() * (C * C.transpose()).inverse() * values_of(constraints);
  const Eigen::MatrixXd Z = Eigen::FullPivLU<Eigen::MatrixXd>(C).kernel();
  const Eigen::MatrixXd reduced = Z.transpose() * problem.hessian * Z;
  const Eigen::VectorXd y = -reduced.fullPivLu().solve(
      Eigen::VectorXd(Z.transpose() * (problem.gradient + problem.hessian * x_0)));
  const Eigen::VectorXd x = x_0 + Z * y;
  EXPECT_LT((problem.step(constraints) - x).norm(), 1e-7 * x.norm());
}

TEST(ConstrainedStep, HoldsThePredictionFromAnyLinearization) {
  const Problem problem;
  PoseConstraints constraints = some_constraints();
  constraints.equal.resize(1);
  NominalState elsewhere = problem.prior.state;
  elsewhere.position += Eigen::Vector3d(0.3, -0.1, 0.0);
  const Belief belief = constrained_step(problem.prior, elsewhere, {problem.scan, {}}, constraints);
  const Eigen::Vector3d moved = belief.state.position - problem.prior.state.position;
  EXPECT_NEAR(constraints.equal[0].direction.tail<3>().dot(moved), 0.0, 1e-12);
}

// A constraint that nothing measured is no information.
TEST(ConstrainedStep, AHeldDirectionKeepsItsVariance) {
  const Problem problem;
  PoseConstraints constraints = some_constraints();
  constraints.equal.resize(1);
  const Vector6 e = constraints.equal[0].direction;
  const Belief held = problem.fused(constraints);
  EXPECT_NEAR(e.dot(pose_block(held.covariance) * e),
              e.dot(pose_block(problem.prior.covariance) * e), 1e-9);
  const Belief plain = problem.fused({});
  EXPECT_LT(e.dot(pose_block(plain.covariance) * e),
            0.6 * e.dot(pose_block(problem.prior.covariance) * e));
}

TEST(ConstrainedStep, StatesTheCovarianceOfItsErrors) {
  Problem problem;
  PoseConstraints constraints = some_constraints();
  constraints.equal.resize(1);
  const Eigen::MatrixXd prior_root = problem.prior.covariance.llt().matrixL();
  const Eigen::SelfAdjointEigenSolver<Matrix6> noise(problem.scan.matrix);
  const Matrix6 noise_root =
      noise.eigenvectors() * noise.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  constexpr int kDraws = 20000;
  constexpr double kScale = 1e-3;  // of the errors, so that rotations add
  ErrorMatrix sample = ErrorMatrix::Zero();
  for (int i = 0; i < kDraws; ++i) {
    ErrorVector drawn;
    for (double& entry : drawn) entry = problem.random.normal();
    const ErrorVector error = kScale * prior_root * drawn;  // the truth from the prior
    Vector6 white;
    for (double& entry : white) entry = problem.random.normal();
    PoseMeasurement scan = problem.scan;
    scan.vector = -scan.matrix * (scan.jacobian * error) + kScale * (noise_root * white);
    const Belief belief =
        constrained_step(problem.prior, problem.prior.state, {scan, {}}, constraints);
    const ErrorVector left = boxminus(boxplus(problem.prior.state, error), belief.state) / kScale;
    sample += left * left.transpose() / kDraws;
  }
  const ErrorMatrix stated = problem.fused(constraints).covariance;
  EXPECT_LT((sample - stated).norm(), 0.05 * stated.norm());
}

TEST(ConstrainedStep, DampingIsAMeasurementThatThePoseIsAsPredicted) {
  const Problem problem;
  PoseConstraints constraints;
  const Vector6 e = some_constraints().equal[0].direction;
  constraints.damping = 3e3 * e * e.transpose();
  PoseMeasurement with = problem.scan;
  with.jacobian.leftCols<6>().setIdentity();
  with.matrix += constraints.damping;  // about the prior: the vector stays
  const Belief expected = fuse(problem.prior, problem.prior.state, with);
  const Belief damped = problem.fused(constraints);
  EXPECT_LT(boxminus(damped.state, expected.state).norm(), 1e-9);
  EXPECT_GT(e.dot(pose_block(damped.covariance) * e), e.dot(pose_block(expected.covariance) * e))
      << "what was not measured is not stated";
}

}  // namespace
}  // namespace aims
