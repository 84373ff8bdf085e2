// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/kalman_update.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/random.hpp"
#include "estimator/legs/leg_velocity_model.hpp"
#include "tests/estimator/finite_differences.hpp"

namespace aims {
namespace {

ErrorMatrix some_covariance(RandomStream& random) {
  ErrorMatrix A;
  for (int i = 0; i < ErrorState::kSize; ++i) {
    for (int j = 0; j < ErrorState::kSize; ++j) A(i, j) = 0.02 * random.normal();
  }
  return A * A.transpose() + 1e-4 * ErrorMatrix::Identity();
}

ErrorVector normal_error(RandomStream& random) {
  ErrorVector v;
  for (int i = 0; i < ErrorState::kSize; ++i) v(i) = random.normal();
  return v;
}

LinearMeasurement some_measurement(const NominalState& at) {
  return leg_velocity_model(at, Pose{}, {0.1, 0.2, 0.3}, {{0.7, 0.0, 0.0}, {0.6, 0.1, 0.0}},
                            0.04 * Eigen::Matrix3d::Identity());
}

TEST(KalmanUpdate, EqualsTheGainForm) {
  RandomStream random(1, "kalman");
  const ErrorMatrix P = some_covariance(random);
  const NominalState state = test::some_state();
  const LinearMeasurement m = some_measurement(state);
  const Belief updated = kalman_update(state, inverse_spd(P), state, information_of(m));
  const Eigen::Matrix3d S = m.jacobian * P * m.jacobian.transpose() + m.noise;
  const Eigen::Matrix<double, ErrorState::kSize, 3> K = P * m.jacobian.transpose() * S.inverse();
  const ErrorVector delta = -K * m.residual;
  const ErrorMatrix I_KH = ErrorMatrix::Identity() - K * m.jacobian;
  const ErrorMatrix joseph = I_KH * P * I_KH.transpose() + K * m.noise * K.transpose();
  const ErrorMatrix G = reset_jacobian(state, delta);
  EXPECT_LT((boxminus(updated.state, state) - delta).norm(), 1e-10);
  EXPECT_LT((updated.covariance - G * joseph * G.transpose()).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(KalmanUpdate, NoInformationChangesNothing) {
  RandomStream random(2, "kalman");
  const ErrorMatrix P = some_covariance(random);
  const NominalState state = test::some_state();
  const Belief same = kalman_update(state, inverse_spd(P), state, Information{});
  EXPECT_LT(boxminus(same.state, state).norm(), 1e-12);
  EXPECT_LT((same.covariance - P).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(KalmanUpdate, IterationConvergesToTheSameStateFromElsewhere) {
  RandomStream random(3, "kalman");
  const ErrorMatrix prior_information = inverse_spd(some_covariance(random));
  const NominalState prior = test::some_state();
  const auto iterate = [&](NominalState at) {
    for (int i = 0; i < 20; ++i) {
      const LinearMeasurement m =
          leg_velocity_model(at, Pose{}, {0.1, 0.2, 0.3}, {{0.7, 0.2, 0.0}, {0.6, 0.1, 0.0}},
                             0.01 * Eigen::Matrix3d::Identity());
      at = kalman_update(prior, prior_information, at, information_of(m)).state;
    }
    return at;
  };
  const NominalState elsewhere = boxplus(prior, 0.1 * normal_error(random));
  EXPECT_LT(boxminus(iterate(elsewhere), iterate(prior)).norm(), 1e-5);
}

TEST(KalmanUpdate, AFullMaskIsTheStandardUpdate) {
  RandomStream random(5, "mask");
  const Belief prior{test::some_state(), some_covariance(random)};
  const NominalState at = boxplus(prior.state, 0.01 * normal_error(random));
  const ErrorMatrix information = inverse_spd(prior.covariance);
  const Information m = information_of(some_measurement(at));
  const Belief plain = kalman_update(prior.state, information, at, m);
  const Belief masked = kalman_update(prior.state, information, at, m, correct_all());
  EXPECT_LT(boxminus(plain.state, masked.state).norm(), 1e-9);
  EXPECT_LT((plain.covariance - masked.covariance).norm(), 1e-9 * plain.covariance.norm());
}

TEST(KalmanUpdate, MaskedDirectionsKeepTheirValueAndUncertainty) {
  RandomStream random(6, "mask");
  const Belief prior{test::some_state(), some_covariance(random)};
  const Eigen::Matrix3d across =
      Eigen::Matrix3d::Identity() - Eigen::Vector3d::UnitX() * Eigen::Vector3d::UnitX().transpose();
  const Belief updated = kalman_update(prior.state, inverse_spd(prior.covariance), prior.state,
                                       information_of(some_measurement(prior.state)),
                                       limit_motion(consider_legs(correct_all()), across));
  EXPECT_NEAR(updated.state.position.x(), prior.state.position.x(), 1e-12);
  EXPECT_NEAR(updated.state.velocity.x(), prior.state.velocity.x(), 1e-12);
  EXPECT_LT((updated.state.leg_scale - prior.state.leg_scale).norm(), 1e-12);
  EXPECT_GT((updated.state.velocity - prior.state.velocity).norm(), 1e-6);
  const int x = ErrorState::kPosition.offset;
  EXPECT_NEAR(updated.covariance(x, x) / prior.covariance(x, x), 1.0, 1e-6);
}

TEST(KalmanUpdate, CovarianceOfAMaskedGainIsJosephsForm) {
  RandomStream random(7, "mask");
  const Belief prior{test::some_state(), some_covariance(random)};
  const LinearMeasurement m = some_measurement(prior.state);
  const ErrorMatrix& P = prior.covariance;
  const Eigen::Matrix3d S = m.jacobian * P * m.jacobian.transpose() + m.noise;
  const ErrorMatrix mask = consider_legs(correct_all());
  const Eigen::Matrix<double, ErrorState::kSize, 3> K =
      mask * P * m.jacobian.transpose() * S.inverse();
  const ErrorMatrix kept = ErrorMatrix::Identity() - K * m.jacobian;
  const ErrorMatrix G = reset_jacobian(prior.state, -K * m.residual);
  const ErrorMatrix expected =
      G * (kept * P * kept.transpose() + K * m.noise * K.transpose()) * G.transpose();
  const Belief updated =
      kalman_update(prior.state, inverse_spd(P), prior.state, information_of(m), mask);
  EXPECT_LT((updated.covariance - expected).norm(), 1e-8 * expected.norm());
}

/// A state of another size: a position on a line.
struct PointOnLine {
  static constexpr int kErrorSize = 1;
  double x = 0.0;
};

using Scalar = Eigen::Matrix<double, 1, 1>;

PointOnLine boxplus(const PointOnLine& at, const Scalar& delta) { return {at.x + delta(0)}; }
Scalar boxminus(const PointOnLine& at, const PointOnLine& origin) {
  return Scalar(at.x - origin.x);
}
Scalar boxminus_jacobian(const PointOnLine& /*origin*/, const Scalar& /*delta*/) {
  return Scalar(1.0);
}
Scalar reset_jacobian(const PointOnLine& /*at*/, const Scalar& /*delta*/) { return Scalar(1.0); }

/// Measurement x^2 = 4 with the deviation 0.1, refused beyond `limit`.
std::optional<Linearization<PointOnLine>> square_is_four(const PointOnLine& at, double limit) {
  if (std::abs(at.x) > limit) return std::nullopt;
  const double slope = 2.0 * at.x;
  const double weight = 1.0 / (0.1 * 0.1);
  return Linearization<PointOnLine>{
      {Scalar(weight * slope * slope), Scalar(weight * slope * (at.x * at.x - 4.0))}, {}};
}

IteratedUpdate<PointOnLine> update_on_line(const BeliefOf<PointOnLine>& prior, int iterations,
                                           double limit) {
  return iterated_update(
      prior, inverse_spd(prior.covariance), iterations,
      [&](const PointOnLine& at) { return square_is_four(at, limit); },
      [](const PointOnLine& before, const PointOnLine& after) {
        return std::abs(after.x - before.x) < 1e-9;
      });
}

TEST(IteratedUpdate, FindsTheMostProbableStateOfAnyStateType) {
  const BeliefOf<PointOnLine> prior{{1.5}, Scalar(0.04)};
  const auto update = update_on_line(prior, 50, 1e9);
  EXPECT_TRUE(update.converged);
  EXPECT_FALSE(update.refused);
  const auto cost = [&](double x) {
    return std::pow((x - 1.5) / 0.2, 2) + std::pow((x * x - 4.0) / 0.1, 2);
  };
  double best = 0.0;
  for (double x = 1.0; x < 3.0; x += 1e-5) best = cost(x) < cost(best) ? x : best;
  EXPECT_NEAR(update.belief.state.x, best, 2e-5);
}

TEST(IteratedUpdate, SaysWhetherItConvergedAndKeepsThePriorWhenRefused) {
  const BeliefOf<PointOnLine> prior{{1.5}, Scalar(0.04)};
  EXPECT_FALSE(update_on_line(prior, 1, 1e9).converged);
  EXPECT_EQ(update_on_line(prior, 1, 1e9).iterations, 1);
  const auto refused = update_on_line(prior, 50, 1.6);
  EXPECT_TRUE(refused.refused);
  EXPECT_EQ(refused.iterations, 1) << "the second linearization was refused";
  EXPECT_EQ(refused.belief.state.x, 1.5);
  EXPECT_EQ(refused.belief.covariance(0), 0.04);
}

}  // namespace
}  // namespace aims
