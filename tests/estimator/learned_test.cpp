// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/interface/learned.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "core/random.hpp"
#include "estimator/filter/entry_information.hpp"

namespace aims {
namespace {

using E = ErrorState;

Belief wide_belief() {
  Belief belief;
  belief.covariance = 0.01 * ErrorMatrix::Identity();
  return belief;
}

/// A velocity that legs report: v + s o u + b, with the noise `sigma`.
LinearMeasurement leg_row(const Belief& at, const Eigen::Vector3d& speed,
                          const Eigen::Vector3d& measured, double sigma) {
  LinearMeasurement m;
  columns(m.jacobian, E::kLegScale) = speed.asDiagonal();
  columns(m.jacobian, E::kLegBias).setIdentity();
  m.residual = at.state.leg_scale.cwiseProduct(speed) + at.state.leg_bias - measured;
  m.noise = sigma * sigma * Eigen::Matrix3d::Identity();
  return m;
}

TEST(Learned, AGaussianSurvivesItsNumbers) {
  Gaussian gaussian{Eigen::Vector3d(1.0, -2.0, 3.0), Eigen::Matrix3d::Identity()};
  gaussian.covariance(0, 2) = gaussian.covariance(2, 0) = 0.25;
  const auto numbers = numbers_of(gaussian);
  ASSERT_EQ(static_cast<int>(numbers.size()), count_of_numbers(3));
  const auto again = gaussian_of(numbers, 3);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->mean, gaussian.mean);
  EXPECT_EQ(again->covariance, gaussian.covariance);
  EXPECT_FALSE(gaussian_of(numbers, 2));
  EXPECT_FALSE(gaussian_of(std::vector{0.0, -1.0}, 1)) << "a negative variance";
}

// The posterior of a scalar: precision-weighted mean.
TEST(Learned, ThePosteriorWeighsPriorAndDataByTheirPrecision) {
  LearnedQuantity quantity;
  quantity.information = Eigen::MatrixXd::Constant(1, 1, 16.0);
  quantity.vector = Eigen::VectorXd::Constant(1, 16.0 * 3.0);
  quantity.prior = Eigen::VectorXd::Constant(1, 1.0);
  quantity.prior_sigma = Eigen::VectorXd::Constant(1, 0.5);
  const Gaussian posterior = posterior_of(quantity);
  EXPECT_NEAR(posterior.mean(0), (16.0 * 3.0 + 4.0 * 1.0) / 20.0, 1e-12);
  EXPECT_NEAR(posterior.covariance(0, 0), 1.0 / 20.0, 1e-12);
}

// The sum over updates is that of the normal equations, whatever the prior of the filter.
TEST(EntryInformation, IsThatOfTheMeasurementsAlone) {
  RandomStream random(3, "test.entry_information");
  Belief belief = wide_belief();
  EntryInformation data(E::kLegScale.offset, E::kLegSize);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(6, 6);
  Eigen::VectorXd vector = Eigen::VectorXd::Zero(6);
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d speed = random.normal3();
    const Eigen::Vector3d measured = 0.1 * random.normal3();
    const LinearMeasurement row = leg_row(belief, speed, measured, 0.2);
    const Belief after = fuse(belief, row);
    data.add(belief, after);
    belief = after;
    const Eigen::MatrixXd h = row.jacobian.middleCols<6>(E::kLegScale.offset);
    expected += h.transpose() * h / 0.04;
    vector += h.transpose() * measured / 0.04;
  }
  EXPECT_LT((data.matrix() - expected).norm(), 1e-6 * expected.norm());
  EXPECT_LT((data.vector() - vector).norm(), 1e-6 * vector.norm());
}

// Of two independent estimates: d^T (S_1 + S_2)^-1 d.
TEST(EntryInformation, DisagreementIsTheNormalizedDifference) {
  Belief belief = wide_belief();
  belief.covariance *= 1e4;
  EntryInformation data(E::kLegScale.offset, 3);
  LinearMeasurement row;
  columns(row.jacobian, E::kLegScale).setIdentity();
  row.residual = -Eigen::Vector3d(0.3, 0.0, 0.0);
  row.noise = 0.01 * Eigen::Matrix3d::Identity();
  data.add(belief, fuse(belief, row));
  const Eigen::Matrix3d known = 0.03 * Eigen::Matrix3d::Identity();
  EXPECT_NEAR(disagreement(data, Eigen::Vector3d::Zero(), known), 0.09 / 0.04, 1e-3);
  EXPECT_NEAR(disagreement(data, Eigen::Vector3d(0.3, 0.0, 0.0), known), 0.0, 1e-6);
  const EntryInformation none(E::kLegScale.offset, 3);
  EXPECT_EQ(disagreement(none, Eigen::Vector3d::Ones(), known), 0.0) << "nothing is contradicted";
}

}  // namespace
}  // namespace aims
