// SPDX-License-Identifier: BSD-3-Clause
// The low-rank updates against dense formulas over the whole error state.
#include "estimator/filter/kalman_update.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/random.hpp"
#include "estimator/legs/leg_velocity_model.hpp"
#include "tests/estimator/finite_differences.hpp"

namespace aims {
namespace {

using E = ErrorState;

ErrorMatrix some_covariance(RandomStream& random) {
  ErrorMatrix A;
  for (double& entry : A.reshaped()) entry = 0.02 * random.normal();
  return A * A.transpose() + 1e-4 * ErrorMatrix::Identity();
}

ErrorVector normal_error(RandomStream& random) {
  ErrorVector v;
  for (double& entry : v) entry = random.normal();
  return v;
}

LinearMeasurement some_legs(const NominalState& at) {
  const Eigen::Matrix3d noise = Eigen::Vector3d(0.04, 0.02, 0.1).asDiagonal();
  return leg_velocity_model(at, Pose{}, {0.1, 0.2, 0.3},
                            {{0.7, 0.0, 0.0}, {0.6, 0.1, 0.0}, {0.6, 0.1, 0.0}}, noise);
}

/// A scan that constrains five of six directions, and depends on mount and delay.
PoseMeasurement some_scan(RandomStream& random) {
  PoseMeasurement scan;
  for (int i = 0; i < 5; ++i) {
    Vector6 row;
    for (double& entry : row) entry = 30.0 * random.normal();
    scan.matrix += row * row.transpose();
    scan.vector += 0.02 * random.normal() * row;
  }
  scan.jacobian.rightCols<4>() = Eigen::Matrix<double, 6, 4>::Random();
  return scan;
}

std::vector<GainMask> some_masks() {
  const Eigen::Matrix3d half = 0.5 * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d across = Eigen::Vector3d(0.0, 1.0, 1.0).asDiagonal();
  return {{},
          {.legs = false},
          {.legs = false, .translation = half},
          {.legs = false, .translation = across}};
}

/// The inverse Jacobian of boxminus(linearization, prior), by finite differences.
ErrorMatrix moved_prior(const NominalState& prior, const NominalState& linearization) {
  const ErrorMatrix J = test::numeric_jacobian<E::kSize>(
      linearization, [&](const NominalState& moved) { return boxminus(moved, prior); });
  return J.inverse();
}

/// The same update with dense matrices: information form for the state, Joseph's form for the
/// covariance, numeric Jacobians of the changes of coordinates.
Belief dense_update(const Belief& prior, const NominalState& at, const ErrorMatrix& A,
                    const ErrorVector& b, const GainMask& mask) {
  const ErrorMatrix T = moved_prior(prior.state, at);
  const ErrorMatrix P = T * prior.covariance * T.transpose();
  const ErrorVector offset = boxminus(at, prior.state);
  const ErrorMatrix full = (P.inverse() + A).inverse();
  const ErrorVector step = -full * (P.inverse() * (T * offset) + b);
  const ErrorMatrix M = mask.matrix();
  const ErrorVector delta = M * (offset + step) - offset;
  const ErrorMatrix kept = ErrorMatrix::Identity() - M * full * A;
  const ErrorMatrix joseph =
      kept * P * kept.transpose() + M * full * A * full.transpose() * M.transpose();
  const NominalState result = boxplus(at, delta);
  const ErrorMatrix G = moved_prior(at, result);
  return {result, G * joseph * G.transpose()};
}

void expect_same(const Belief& a, const Belief& b) {
  EXPECT_LT(boxminus(a.state, b.state).norm(), 1e-8);
  EXPECT_LT((a.covariance - b.covariance).norm(), 1e-6 * b.covariance.norm());
  EXPECT_EQ(a.covariance, ErrorMatrix(a.covariance.transpose()));
}

TEST(KalmanUpdate, OfThreeRowsEqualsTheDenseOne) {
  RandomStream random(1, "kalman");
  const Belief prior{test::some_state(), some_covariance(random)};
  const LinearMeasurement m = some_legs(prior.state);
  const Matrix3xError weighted = m.noise.inverse() * m.jacobian;
  for (const GainMask& mask : some_masks()) {
    expect_same(fuse(prior, m, mask),
                dense_update(prior, prior.state, m.jacobian.transpose() * weighted,
                             weighted.transpose() * m.residual, mask));
  }
}

TEST(KalmanUpdate, OfAScanEqualsTheDenseOneAtAnyLinearization) {
  RandomStream random(2, "kalman");
  const Belief prior{test::some_state(), some_covariance(random)};
  const PoseMeasurement scan = some_scan(random);
  const ErrorMatrix A = scan.jacobian.transpose() * scan.matrix * scan.jacobian;
  const ErrorVector b = scan.jacobian.transpose() * scan.vector;
  for (const GainMask& mask : some_masks()) {
    for (const double away : {0.0, 0.1}) {
      const NominalState at = boxplus(prior.state, away * normal_error(random));
      expect_same(fuse(prior, at, scan, mask), dense_update(prior, at, A, b, mask));
    }
  }
}

TEST(KalmanUpdate, NoInformationChangesNothing) {
  RandomStream random(3, "kalman");
  const Belief prior{test::some_state(), some_covariance(random)};
  const NominalState elsewhere = boxplus(prior.state, 0.1 * normal_error(random));
  EXPECT_LT(boxminus(fuse(prior, elsewhere, {}).state, prior.state).norm(), 1e-12);
  const Belief same = fuse(prior, prior.state, {});
  EXPECT_LT((same.covariance - prior.covariance).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(KalmanUpdate, AnAccurateScanLeavesACovarianceAfterAnUncertainPrior) {
  RandomStream random(4, "kalman");
  const Belief prior{test::some_state(), 1e4 * ErrorMatrix::Identity()};
  const PoseMeasurement exact{1e8 * Matrix6::Identity()};
  const Belief updated = fuse(prior, prior.state, exact);
  EXPECT_NEAR(updated.covariance(0, 0) / 1e-8, 1.0, 1e-3);
  EXPECT_NEAR(updated.covariance(E::kDelay, E::kDelay), 1e4, 1e-6);
}

TEST(KalmanUpdate, MaskedDirectionsKeepTheirValueAndUncertainty) {
  RandomStream random(6, "mask");
  const Belief prior{test::some_state(), some_covariance(random)};
  const Eigen::Matrix3d across = Eigen::Vector3d(0.0, 1.0, 1.0).asDiagonal();
  const Belief updated =
      fuse(prior, some_legs(prior.state), {.legs = false, .translation = across});
  EXPECT_NEAR(updated.state.position.x(), prior.state.position.x(), 1e-12);
  EXPECT_NEAR(updated.state.velocity.x(), prior.state.velocity.x(), 1e-12);
  EXPECT_LT((updated.state.leg_scale - prior.state.leg_scale).norm(), 1e-12);
  EXPECT_GT((updated.state.velocity - prior.state.velocity).norm(), 1e-6);
  const int x = E::kPosition.offset;
  EXPECT_NEAR(updated.covariance(x, x) / prior.covariance(x, x), 1.0, 1e-6);
}

// The gain is that of the covariance given the legs, from its definition; the covariance is
// Joseph's form over the whole state.
TEST(KalmanUpdate, GivenLegsEqualsTheDenseOne) {
  RandomStream random(7, "given_legs");
  const Belief prior{test::some_state(), some_covariance(random)};
  const LinearMeasurement m = some_legs(prior.state);
  const ErrorMatrix& P = prior.covariance;
  const auto legs = Eigen::seqN(E::kLegScale.offset, E::kLegSize);
  const Matrix6 inverse = P(legs, legs).inverse();
  const ErrorMatrix given = P - P(Eigen::all, legs) * inverse * P(legs, Eigen::all);
  const Eigen::Matrix3d S = m.jacobian * given * m.jacobian.transpose() + m.noise;
  const Eigen::Matrix<double, E::kSize, 3> K = given * m.jacobian.transpose() * S.inverse();
  const ErrorMatrix kept = ErrorMatrix::Identity() - K * m.jacobian;
  const NominalState result = boxplus(prior.state, -K * m.residual);
  const ErrorMatrix G = moved_prior(prior.state, result);
  const ErrorMatrix joseph = kept * P * kept.transpose() + K * m.noise * K.transpose();
  expect_same(fuse_given_legs(prior, m), {result, G * joseph * G.transpose()});
  EXPECT_LT((result.leg_scale - prior.state.leg_scale).norm(), 1e-12);
}

/// The covariance that a filter states whose gains are those of the covariance `of_gain`.
ErrorMatrix stated_after(const ErrorMatrix& of_gain, const ErrorMatrix& stated,
                         const LinearMeasurement& m) {
  const Eigen::Matrix3d S = m.jacobian * of_gain * m.jacobian.transpose() + m.noise;
  const Eigen::Matrix<double, E::kSize, 3> K = of_gain * m.jacobian.transpose() * S.inverse();
  const ErrorMatrix kept = ErrorMatrix::Identity() - K * m.jacobian;
  return kept * stated * kept.transpose() + K * m.noise * K.transpose();
}

// The state follows all of the scan, the stated covariance what the scan states.
TEST(KalmanUpdate, AScanThatStatesLessThanItWeighsLeavesAnExcess) {
  RandomStream random(9, "excess");
  const Belief prior{test::some_state(), some_covariance(random)};
  const NominalState at = boxplus(prior.state, 0.1 * normal_error(random));
  PoseMeasurement scan = some_scan(random);
  const Belief whole = fuse(prior, at, scan, {.legs = false});
  scan.stated = 0.02 * scan.matrix;
  const Belief updated = fuse(prior, at, scan, {.legs = false});
  EXPECT_EQ(boxminus(updated.state, whole.state).norm(), 0.0);
  EXPECT_EQ(updated.covariance, whole.covariance);
  const PoseMeasurement less{*scan.stated, 0.02 * scan.vector, scan.jacobian};
  const ErrorMatrix expected = fuse(prior, at, less, {.legs = false}).covariance;
  // About another result: what the reset of the rotation changes is small.
  EXPECT_LT((stated_covariance(updated) - expected).norm(), 0.1 * expected.norm());
  EXPECT_GT((stated_covariance(updated) - whole.covariance).norm(), 0.2 * expected.norm());
}

TEST(KalmanUpdate, TheExcessGoesThroughTheGainsOfTheCovariance) {
  RandomStream random(10, "excess");
  Belief prior{test::some_state(), some_covariance(random)};
  prior.excess = some_covariance(random);
  LinearMeasurement m = some_legs(prior.state);
  m.residual.setZero();  // no reset
  EXPECT_LT((stated_covariance(fuse(prior, m)) -
             stated_after(prior.covariance, stated_covariance(prior), m))
                .norm(),
            1e-9);
  const Belief given = fuse_given_legs(prior, m);
  const auto legs = Eigen::seqN(E::kLegScale.offset, E::kLegSize);
  EXPECT_LT((stated_covariance(given)(legs, legs) - stated_covariance(prior)(legs, legs)).norm(),
            1e-9);
  PoseMeasurement scan = some_scan(random);
  scan.vector.setZero();
  const PoseMeasurement same{scan.matrix, scan.vector, scan.jacobian, scan.matrix};
  const Belief none{prior.state, prior.covariance};
  EXPECT_LT(fuse(none, prior.state, same).excess->norm(), 1e-12);
  const ErrorMatrix A = scan.jacobian.transpose() * scan.matrix * scan.jacobian;
  const ErrorMatrix kept = ErrorMatrix::Identity() - (prior.covariance.inverse() + A).inverse() * A;
  EXPECT_LT(
      (*fuse(prior, prior.state, scan).excess - kept * *prior.excess * kept.transpose()).norm(),
      1e-6 * prior.excess->norm());
}

TEST(KalmanUpdate, GivenLegsThatAreKnownItIsThePlainOne) {
  RandomStream random(8, "known_legs");
  const ErrorMatrix legs_kept = GainMask{.legs = false}.matrix();
  const Belief prior{test::some_state(), legs_kept * some_covariance(random) * legs_kept};
  const LinearMeasurement m = some_legs(prior.state);
  expect_same(fuse_given_legs(prior, m), fuse(prior, m));
}

/// Ten seconds at 0.7 m/s, with a noisy IMU and legs that are 5 % short.
class Walk {
 public:
  explicit Walk(std::uint64_t seed) : random_(seed, "walk") {
    belief_.state.velocity.x() = kReported;
    belief_.covariance = 1e-10 * ErrorMatrix::Identity();
    block(belief_.covariance, E::kLegScale, E::kLegScale) *= 0.05 * 0.05 / 1e-10;
  }

  /// The distance of the estimate from the path that the legs report [m]. `update(belief, legs)`.
  template <class Update>
  double run(const Update& update) {
    double reported = 0.0;
    for (int i = 0; i < 2000; ++i) {
      predict();
      const double sample = kReported + kLegNoise * random_.normal();
      reported += sample * kStep;
      const LegVelocity legs{{sample, 0.0, 0.0}, {kReported, 0.0, 0.0}, {kReported, 0.0, 0.0}};
      belief_ = update(belief_, leg_velocity_model(belief_.state, Pose{}, Eigen::Vector3d::Zero(),
                                                   legs, kLegNoise * kLegNoise * I3()));
    }
    return belief_.state.position.x() - reported;
  }

  /// Of the position along the path [m].
  double stated() const {
    return std::sqrt(belief_.covariance(E::kPosition.offset, E::kPosition.offset));
  }

  static constexpr double kSpeed = 0.7;

 private:
  static constexpr double kReported = 0.95 * kSpeed;
  static constexpr double kStep = 0.005;
  static constexpr double kImuNoise = 0.2;  // [m/s^2/sqrt(Hz)]
  static constexpr double kLegNoise = 0.4;  // [m/s]
  static Eigen::Matrix3d I3() { return Eigen::Matrix3d::Identity(); }

  void predict() {
    ErrorMatrix F = ErrorMatrix::Identity();
    block(F, E::kPosition, E::kVelocity) = kStep * I3();
    belief_.state.position += kStep * belief_.state.velocity;
    belief_.state.velocity.x() += kImuNoise * std::sqrt(kStep) * random_.normal();
    belief_.covariance = F * belief_.covariance * F.transpose();
    block(belief_.covariance, E::kVelocity, E::kVelocity) += kImuNoise * kImuNoise * kStep * I3();
  }

  RandomStream random_;
  Belief belief_;
};

// With legs alone the position is where they report it. A velocity that is corrected without the
// position lags behind its own corrections, and the noise of the IMU meanwhile stays in the
// position.
TEST(KalmanUpdate, GivenLegsThePositionIsTheIntegralOfWhatTheyReport) {
  double squared = 0.0;
  double squared_velocity_only = 0.0;
  constexpr int kWalks = 20;
  for (int seed = 1; seed <= kWalks; ++seed) {
    Walk walk(static_cast<std::uint64_t>(seed));
    squared += std::pow(walk.run([](const Belief& b, const LinearMeasurement& m) {
                 return fuse_given_legs(b, m);
               }),
                        2) /
               kWalks;
    EXPECT_NEAR(walk.stated(), 10.0 * Walk::kSpeed * 0.05, 0.1) << "mostly the scale";
    Walk other(static_cast<std::uint64_t>(seed));
    const double error_velocity_only = other.run([](const Belief& belief, const auto& legs) {
      Belief updated = fuse(belief, legs, {.legs = false});
      updated.state.position = belief.state.position;
      return updated;
    });
    squared_velocity_only += std::pow(error_velocity_only, 2) / kWalks;
  }
  EXPECT_LT(std::sqrt(squared), 0.03);
  EXPECT_GT(std::sqrt(squared_velocity_only), 0.06);
}

TEST(GainMask, LeavesOutTheLegsAndNothingElse) {
  ErrorMatrix expected = ErrorMatrix::Identity();
  EXPECT_EQ(GainMask().matrix(), expected);
  for (const E::Block legs : {E::kLegScale, E::kLegBias}) block(expected, legs, legs).setZero();
  EXPECT_EQ(GainMask{.legs = false}.matrix(), expected) << "mount and delay are corrected";
}

// Its error is of second order: a tenth of the distance, a hundredth of the error.
TEST(LinearMeasurement, HasTheResidualOfTheStateThatItIsMovedTo) {
  RandomStream random(5, "moved_measurement");
  const NominalState from = boxplus(NominalState(), 0.2 * normal_error(random));
  const ErrorVector direction = normal_error(random);
  const auto error_at = [&](double distance) {
    const NominalState to = boxplus(from, distance * direction);
    return (moved_to(some_legs(from), from, to).residual - some_legs(to).residual).norm();
  };
  const NominalState far = boxplus(from, 0.1 * direction);
  const double without = (some_legs(from).residual - some_legs(far).residual).norm();
  EXPECT_LT(error_at(0.1), 0.2 * without);
  EXPECT_NEAR(error_at(0.01) / error_at(0.1), 0.01, 0.004);
}

/// Measurement x^2 = 4 of the position with the deviation 0.1, refused beyond `limit`.
std::optional<Linearization> square_is_four(const NominalState& at, double limit) {
  const double x = at.position.x();
  if (std::abs(x) > limit) return std::nullopt;
  const double slope = 2.0 * x;
  const double weight = 1.0 / (0.1 * 0.1);
  Linearization linearization;
  linearization.measurement.matrix(3, 3) = weight * slope * slope;
  linearization.measurement.vector(3) = weight * slope * (x * x - 4.0);
  return linearization;
}

Belief prior_on_line() {
  Belief prior;
  prior.state.position.x() = 1.5;
  prior.covariance *= 0.04;
  return prior;
}

/// Steps beyond `large` are large.
IteratedUpdate update_on_line(int iterations, double limit, double start = 1.5,
                              double large = 1e9) {
  NominalState first;
  first.position.x() = start;
  return iterated_update(
      prior_on_line(), first, iterations,
      [&](const NominalState& at) { return square_is_four(at, limit); },
      [&](const NominalState& before, const NominalState& after) {
        const double length = (after.position - before.position).norm();
        if (length > large) return Step::kLarge;
        return length < 1e-9 ? Step::kConverged : Step::kSmall;
      });
}

TEST(IteratedUpdate, FindsTheMostProbableState) {
  const IteratedUpdate update = update_on_line(50, 1e9);
  EXPECT_TRUE(update.converged);
  EXPECT_FALSE(update.refused);
  const auto cost = [&](double x) {
    return std::pow((x - 1.5) / 0.2, 2) + std::pow((x * x - 4.0) / 0.1, 2);
  };
  double best = 0.0;
  for (double x = 1.0; x < 3.0; x += 1e-5) best = cost(x) < cost(best) ? x : best;
  EXPECT_NEAR(update.belief.state.position.x(), best, 2e-5);
}

TEST(IteratedUpdate, FindsTheSameStateInFewerStepsFromNearby) {
  const IteratedUpdate far = update_on_line(50, 1e9);
  const IteratedUpdate near = update_on_line(50, 1e9, 1.9);
  EXPECT_NEAR(near.belief.state.position.x(), far.belief.state.position.x(), 1e-9);
  EXPECT_LT(near.iterations, far.iterations);
}

TEST(IteratedUpdate, NeverEndsWithALargeStep) {
  const double found = update_on_line(50, 1e9).belief.state.position.x();
  EXPECT_GT(std::abs(update_on_line(1, 1e9).belief.state.position.x() - found), 0.02);
  const IteratedUpdate update = update_on_line(1, 1e9, 1.5, 0.01);
  EXPECT_GT(update.iterations, 1);
  EXPECT_NEAR(update.belief.state.position.x(), found, 1e-3);
  const IteratedUpdate endless = update_on_line(1, 1e9, 1.5, -1.0);
  EXPECT_EQ(endless.iterations, kMaxSteps) << "all steps are large";
  EXPECT_FALSE(endless.converged);
}

TEST(IteratedUpdate, SaysWhetherItConvergedAndKeepsThePriorWhenRefused) {
  EXPECT_FALSE(update_on_line(1, 1e9).converged);
  EXPECT_EQ(update_on_line(1, 1e9).iterations, 1);
  const IteratedUpdate refused = update_on_line(50, 1.6);
  EXPECT_TRUE(refused.refused);
  EXPECT_EQ(refused.iterations, 1) << "the second linearization was refused";
  EXPECT_EQ(refused.belief.state.position.x(), 1.5);
  EXPECT_EQ(refused.belief.covariance, prior_on_line().covariance);
}

TEST(GainMask, KeepsHeadingAndGyroBiasWithTheirUncertainty) {
  Belief prior;
  prior.covariance = 0.01 * ErrorMatrix::Identity();
  block(prior.covariance, ErrorState::kRotation, ErrorState::kVelocity) =
      0.005 * Eigen::Matrix3d::Identity();
  block(prior.covariance, ErrorState::kVelocity, ErrorState::kRotation) =
      0.005 * Eigen::Matrix3d::Identity();
  block(prior.covariance, ErrorState::kGyroBias, ErrorState::kVelocity) =
      0.004 * Eigen::Matrix3d::Identity();
  block(prior.covariance, ErrorState::kVelocity, ErrorState::kGyroBias) =
      0.004 * Eigen::Matrix3d::Identity();
  LinearMeasurement velocity;
  velocity.residual = Eigen::Vector3d(0.2, -0.1, 0.3);
  columns(velocity.jacobian, ErrorState::kVelocity).setIdentity();
  velocity.noise = 0.01 * Eigen::Matrix3d::Identity();
  GainMask mask;
  mask.gyro_bias = false;
  mask.rotation = Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal();
  const Belief after = fuse(prior, velocity, mask);
  EXPECT_NEAR(yaw_of(after.state.rotation), 0.0, 1e-3);  // tilts about two axes turn a little
  EXPECT_GT(after.state.rotation.angularDistance(prior.state.rotation), 0.01);
  EXPECT_EQ(after.state.gyro_bias, prior.state.gyro_bias);
  EXPECT_NEAR(after.covariance(9, 9), prior.covariance(9, 9), 1e-12);
  EXPECT_LT(after.covariance(6, 6), prior.covariance(6, 6));
}

}  // namespace
}  // namespace aims
