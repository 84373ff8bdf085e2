// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/leg_states.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace aims {
namespace {

using E = ErrorState;

Belief fixed_legs() {
  Belief belief;
  belief.covariance = 1e-16 * ErrorMatrix::Identity();
  return belief;
}

TEST(LegStates, OnlyEnabledStatesGetVariance) {
  LegStatesConfig config;
  config.scale_sigma = 0.1;
  config.bias_sigma = 0.02;
  const Belief fixed = open_leg_states(fixed_legs(), config);
  EXPECT_EQ(fixed.covariance, fixed_legs().covariance);
  config.enabled = true;
  const Belief open = open_leg_states(fixed_legs(), config);
  EXPECT_NEAR(block(open.covariance, E::kLegScale, E::kLegScale)(1, 1), 0.01, 1e-12);
  EXPECT_NEAR(block(open.covariance, E::kLegBias, E::kLegBias)(1, 1), 0.0004, 1e-12);
}

TEST(LegStates, VarianceGrowsWithTime) {
  LegStatesConfig config;
  config.enabled = true;
  Belief belief = fixed_legs();
  for (int i = 0; i < 100; ++i) walk_leg_states(belief, config, 0.05);
  EXPECT_NEAR(block(belief.covariance, E::kLegScale, E::kLegScale)(0, 0),
              5.0 * kLegScaleWalk * kLegScaleWalk, 1e-12);
  EXPECT_NEAR(block(belief.covariance, E::kLegBias, E::kLegBias)(2, 2),
              5.0 * kLegBiasWalk * kLegBiasWalk, 1e-14);
}

TEST(LegStates, StrideMeanKeepsTheMeanAndDampsTheOscillation) {
  StrideMean mean;
  double lowest = 1e9;
  double highest = -1e9;
  for (int i = 0; i < 2000; ++i) {
    LegOdometrySample sample;
    sample.stamp = i * 5 * kMillisecond;
    sample.linear_velocity.x() = 0.7 + 0.1 * std::sin(2.0 * M_PI * 4.0 * i * 0.005);
    const double now = mean.update(sample).x();
    if (i > 1000) {
      lowest = std::min(lowest, now);
      highest = std::max(highest, now);
    }
  }
  EXPECT_NEAR(0.5 * (lowest + highest), 0.7, 2e-3);
  EXPECT_LT(highest - lowest, 0.1 * 0.2) << "a tenth of the oscillation";
}

}  // namespace
}  // namespace aims
