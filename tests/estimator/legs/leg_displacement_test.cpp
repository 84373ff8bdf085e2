// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/leg_displacement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace aims {
namespace {

using Motion = std::function<LegOdometrySample(double)>;

/// The packet of a base that speeds up along its x axis.
LegOdometrySample speeding_up(double t) {
  LegOdometrySample sample;
  sample.linear_velocity = {0.2 + 1.5 * t, 0.0, 0.0};
  return sample;
}

/// The packet of a base on a circle.
LegOdometrySample circling(double) {
  LegOdometrySample sample;
  sample.linear_velocity = {0.7, 0.0, 0.0};
  sample.angular_velocity = {0.0, 0.0, 1.2};
  return sample;
}

/// Packets every 5 ms from 0.002 s, without those numbered from `lost` up to `found`; the interval
/// is (0, end].
std::optional<LegDisplacement> integrate(const Motion& motion, double end, int lost = 0,
                                         int found = 0) {
  LegIntegrator integrator{LegConfig{}};
  integrator.begin(0);
  for (int i = 0; 0.002 + 0.005 * i <= end; ++i) {
    if (i >= lost && i < found) continue;
    LegOdometrySample sample = motion(0.002 + 0.005 * i);
    sample.stamp = from_seconds(0.002 + 0.005 * i);
    integrator.add(sample);
  }
  return integrator.until(from_seconds(end));
}

TEST(LegIntegrator, IsExactOnACircle) {
  const auto measured = integrate(circling, 0.1);
  ASSERT_TRUE(measured);
  const double angle = 1.2 * 0.1;
  const double radius = 0.7 / 1.2;
  const Eigen::Vector3d truth(radius * std::sin(angle), radius * (1.0 - std::cos(angle)), 0.0);
  EXPECT_LT((measured->translation - truth).norm(), 1e-9);
  EXPECT_EQ(measured->packets, 20);
  EXPECT_EQ(measured->duration, from_seconds(0.1));
}

TEST(LegIntegrator, BridgesAGapByTheMeanOfItsNeighbours) {
  const auto whole = integrate(speeding_up, 0.1);
  const auto gap = integrate(speeding_up, 0.1, 5, 13);
  ASSERT_TRUE(whole && gap);
  // Velocity is linear in time, so the mean of the neighbours is the mean over the gap.
  EXPECT_NEAR(gap->translation.x(), whole->translation.x(), 1e-12);
  EXPECT_EQ(gap->packets, 12);
}

TEST(LegIntegrator, RefusesAnIntervalThatMissesMoreThanHalfItsPackets) {
  EXPECT_TRUE(integrate(circling, 0.1, 2, 12));
  EXPECT_FALSE(integrate(circling, 0.1, 2, 13));
  EXPECT_FALSE(integrate(circling, 0.1, 0, 20));
}

TEST(LegIntegrator, IntervalsAddUpToTheWhole) {
  LegIntegrator whole{LegConfig{}};
  LegIntegrator parts{LegConfig{}};
  whole.begin(0);
  parts.begin(0);
  double sum = 0.0;
  for (int i = 0; i < 40; ++i) {
    if (i == 20) {
      sum += parts.until(from_seconds(0.1))->translation.x();
      parts.begin(from_seconds(0.1));
    }
    LegOdometrySample sample = speeding_up(0.005 * i);
    sample.stamp = from_seconds(0.005 * i);
    whole.add(sample);
    parts.add(sample);
  }
  sum += parts.until(from_seconds(0.2))->translation.x();
  // At the end of the first part the last velocity stands for 5 ms of a motion that speeds up.
  EXPECT_NEAR(sum, whole.until(from_seconds(0.2))->translation.x(), 1.5 * 0.005 * 0.005);
}

}  // namespace
}  // namespace aims
