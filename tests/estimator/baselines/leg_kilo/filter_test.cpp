// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/leg_kilo/filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>

#include "tests/estimator/baselines/leg_kilo/random_states.hpp"

namespace aims::leg_kilo {
namespace {

constexpr unsigned kSeed = 3;

ErrorVector difference(const State& to, const State& from) {
  ErrorVector error;
  error << so3_log(from.T_world_body.rotation.conjugate() * to.T_world_body.rotation),
      to.T_world_body.translation - from.T_world_body.translation, to.velocity - from.velocity,
      to.accelerometer_bias - from.accelerometer_bias, to.gyro_bias - from.gyro_bias,
      to.gravity - from.gravity, to.force - from.force, to.rate - from.rate;
  return error;
}

TEST(LegKiloFilter, CovarianceIsThatOfTheStepsDerivativeByFiniteDifferences) {
  // The published derivative leaves out terms of second order in dt times the rate: 3e-6 here.
  constexpr double kPeriod = 2e-3;
  constexpr double kStep = 1e-6;
  std::mt19937 random(kSeed);
  for (int i = 0; i < 10; ++i) {
    const State x = test::random_state(random);
    const State y = predicted(x, kPeriod);
    ErrorMatrix F;
    for (int k = 0; k < Error::kSize; ++k) {
      const ErrorVector step = kStep * ErrorVector::Unit(k);
      F.col(k) = (difference(predicted(plus(x, step), kPeriod), y) -
                  difference(predicted(plus(x, -step), kPeriod), y)) /
                 (2.0 * kStep);
    }
    const ErrorMatrix P = test::random_covariance(random, 0.1);
    const ErrorMatrix predicted_P = predicted_covariance(P, x, kPeriod, {0.0, 0.0, 0.0, 0.0, 0.0});
    EXPECT_LT((predicted_P - F * P * F.transpose()).cwiseAbs().maxCoeff(), 1e-5)
        << "seed " << kSeed;
    EXPECT_GT((predicted_P - P).cwiseAbs().maxCoeff(), 1e-3);
  }
}

TEST(LegKiloFilter, NoiseGrowsWithTheSquareOfTheStep) {
  const ErrorMatrix Q =
      predicted_covariance(ErrorMatrix::Zero(), State(), 0.1, {1.0, 2.0, 3.0, 4.0, 5.0});
  ErrorVector expected = ErrorVector::Zero();
  expected.segment<3>(Error::kVelocity).setConstant(0.01);
  expected.segment<3>(Error::kForce).setConstant(0.02);
  expected.segment<3>(Error::kRate).setConstant(0.03);
  expected.segment<3>(Error::kAccelerometerBias).setConstant(0.04);
  expected.segment<3>(Error::kGyroBias).setConstant(0.05);
  EXPECT_LT((Q - ErrorMatrix(expected.asDiagonal())).norm(), 1e-12);
}

/// The posterior in information form, for `H` padded with zeros to the whole error.
void expect_is_posterior(const Belief& posterior, const Belief& prior, const Eigen::MatrixXd& H,
                         const Eigen::VectorXd& innovation, const Eigen::VectorXd& variance) {
  const Eigen::MatrixXd weighted = H.transpose() * variance.cwiseInverse().asDiagonal();
  const ErrorMatrix covariance = (prior.covariance.inverse() + weighted * H).inverse();
  EXPECT_LT((posterior.covariance - covariance).norm(), 1e-8) << "seed " << kSeed;
  const ErrorVector delta = covariance * weighted * innovation;
  EXPECT_LT((difference(posterior.state, prior.state) - delta).norm(), 1e-8) << "seed " << kSeed;
}

TEST(LegKiloFilter, UpdatesAreThoseOfTheInformationForm) {
  std::mt19937 random(kSeed);
  for (const Eigen::Index rows : {1, 2, 9}) {
    const Belief prior{test::random_state(random), test::random_covariance(random, 0.1)};
    Observation whole(rows);
    whole.jacobian.setRandom();
    whole.innovation = 0.1 * Eigen::VectorXd::Random(rows);
    whole.variance = Eigen::VectorXd::LinSpaced(rows, 0.01, 0.03);
    expect_is_posterior(updated(prior, whole), prior, whole.jacobian, whole.innovation,
                        whole.variance);

    const PoseObservation pose{whole.innovation, whole.jacobian.leftCols<Error::kPose>(),
                               whole.variance};
    Eigen::MatrixXd padded = Eigen::MatrixXd::Zero(rows, Error::kSize);
    padded.leftCols<Error::kPose>() = pose.jacobian;
    // As published, a point that is alone has 1e-4 m^2 more.
    const double added = rows == 1 ? 1e-4 : 0.0;
    expect_is_posterior(updated(prior, pose), prior, padded, pose.innovation,
                        pose.variance.array() + added);
  }
}

TEST(LegKiloFilter, AStateThatIsNoNumberOrFarAwayIsOfNoUse) {
  EXPECT_TRUE(is_usable(Belief()));
  Belief far;
  far.state.T_world_body.translation.x() = 1e6;
  EXPECT_FALSE(is_usable(far));
  Belief broken;
  broken.state.rate.z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_usable(broken));
  Belief wide;
  wide.covariance(3, 3) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(is_usable(wide));
}

}  // namespace
}  // namespace aims::leg_kilo
