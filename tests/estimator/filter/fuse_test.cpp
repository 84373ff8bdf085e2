// SPDX-License-Identifier: BSD-3-Clause
// The gain form of the update against the information form and against dense formulas.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "core/random.hpp"
#include "estimator/filter/kalman_update.hpp"
#include "estimator/legs/leg_velocity_model.hpp"
#include "tests/estimator/finite_differences.hpp"

namespace aims {
namespace {

using E = ErrorState;

Belief some_belief() {
  RandomStream random(1, "fuse");
  ErrorMatrix A;
  for (double& entry : A.reshaped()) entry = 0.02 * random.normal();
  return {test::some_state(), A * A.transpose() + 1e-4 * ErrorMatrix::Identity()};
}

LinearMeasurement some_measurement(const NominalState& at) {
  const Eigen::Matrix3d noise = Eigen::Vector3d(0.04, 0.02, 0.1).asDiagonal();
  return leg_velocity_model(at, Pose{}, {0.1, 0.2, 0.3}, {{0.7, 0.0, 0.0}, {0.6, 0.1, 0.0}}, noise);
}

void expect_same(const Belief& a, const Belief& b) {
  EXPECT_LT(boxminus(a.state, b.state).norm(), 1e-10);
  EXPECT_LT((a.covariance - b.covariance).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(Fuse, EqualsTheInformationForm) {
  const Belief prior = some_belief();
  const LinearMeasurement m = some_measurement(prior.state);
  expect_same(fuse(prior, m), kalman_update(prior.state, inverse_spd(prior.covariance), prior.state,
                                            information_of(m)));
}

TEST(Fuse, EqualsTheInformationFormWithAMask) {
  const Belief prior = some_belief();
  const LinearMeasurement m = some_measurement(prior.state);
  const Eigen::Matrix3d half = 0.5 * Eigen::Matrix3d::Identity();
  for (const ErrorMatrix& mask :
       {consider_legs(correct_all()), limit_motion(consider_legs(correct_all()), half)}) {
    expect_same(fuse(prior, m, mask), kalman_update(prior.state, inverse_spd(prior.covariance),
                                                    prior.state, information_of(m), mask));
  }
}

TEST(Fuse, ConsidersTheLegsAndNothingElse) {
  const ErrorMatrix mask = consider_legs(correct_all());
  ErrorMatrix expected = ErrorMatrix::Identity();
  for (const E::Block legs : {E::kLegScale, E::kLegBias}) block(expected, legs, legs).setZero();
  EXPECT_EQ(mask, expected) << "mount and delay are corrected";
}

}  // namespace
}  // namespace aims
