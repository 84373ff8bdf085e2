// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/degeneracy/degeneracy.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace aims {
namespace {

TEST(Degeneracy, ResidualStatisticsMatchHandValues) {
  const std::array<double, 4> residuals{1.0, 2.0, 3.0, 6.0};
  const ResidualStatistics s = residual_statistics(residuals);
  EXPECT_DOUBLE_EQ(s.mean, 3.0);
  EXPECT_DOUBLE_EQ(s.variance, 3.5);
  EXPECT_EQ(residual_statistics({}).variance, 0.0);
}

TEST(Degeneracy, ObservabilityIsHalfAtTheNominalDispersion) {
  EXPECT_DOUBLE_EQ(effective_observability(0.01 * 0.01, 0.01), 0.5);
  EXPECT_DOUBLE_EQ(effective_observability(0.0, 0.01), 0.0);
  EXPECT_NEAR(effective_observability(1e6, 0.01), 1.0, 1e-9);
}

TEST(Degeneracy, ConsistencyIsTheSquaredMahalanobisLength) {
  const Vector6 y = (Vector6() << 1.0, 0.0, 0.0, 0.0, 2.0, 0.0).finished();
  const Matrix6 P = (Vector6() << 4.0, 1.0, 1.0, 1.0, 2.0, 1.0).finished().asDiagonal();
  EXPECT_DOUBLE_EQ(consistency(y, P), 0.25 + 2.0);
  ErrorVector full = ErrorVector::Zero();
  full.head<6>() = y;
  EXPECT_DOUBLE_EQ(consistency_full(full, 0.5 * ErrorMatrix::Identity()), 10.0);
}

TEST(Degeneracy, SeverityReachesItsLimits) {
  const DegeneracyConfig config{.w1 = 0.3};
  EXPECT_DOUBLE_EQ(degeneracy_severity(1.0, 0.0, config), 0.0);
  EXPECT_DOUBLE_EQ(degeneracy_severity(0.0, 0.0, config), 0.3);
  EXPECT_NEAR(degeneracy_severity(0.0, 1e12, config), 1.0, 1e-9);
  EXPECT_DOUBLE_EQ(degeneracy_severity(1.0, config.kappa, config), 0.35);
}

TEST(Degeneracy, WeightsStayInTheirRanges) {
  const DegeneracyConfig config{.eta = 3.0, .gamma_min = 0.3};
  EXPECT_DOUBLE_EQ(lidar_reliability(0.0, config), 1.0);
  EXPECT_DOUBLE_EQ(lidar_reliability(1.0, config), std::exp(-3.0));
  EXPECT_DOUBLE_EQ(leg_reliability(0.0, config), 1.0);
  EXPECT_DOUBLE_EQ(leg_reliability(1.0, config), 0.3);
  EXPECT_DOUBLE_EQ(leg_reliability(0.5, config), 0.65);
}

TEST(Degeneracy, SmoothingStartsAtTheFirstIndexAndConverges) {
  SeverityFilter filter(0.9);
  EXPECT_DOUBLE_EQ(filter.update(0.4), 0.4);
  EXPECT_DOUBLE_EQ(filter.update(1.0), 0.9 * 0.4 + 0.1);
  for (int i = 0; i < 200; ++i) filter.update(0.2);
  EXPECT_NEAR(filter.value(), 0.2, 1e-8);
}

}  // namespace
}  // namespace aims
