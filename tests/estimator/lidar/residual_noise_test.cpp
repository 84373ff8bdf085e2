// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/residual_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"

namespace aims {
namespace {

constexpr double kRest = 0.012;   // map, pose and motion [m]
constexpr double kRange = 0.045;  // along the beam [m]
constexpr double kGate = 0.2;     // of residuals [m]

/// Residuals of a scan, a fraction of them of things that move: anywhere within the gate.
std::vector<IncidentResidual> drawn_scan(RandomStream& random, double outliers) {
  std::vector<IncidentResidual> scan;
  for (int i = 0; i < 1000; ++i) {
    const double cosine = random.uniform();
    const double residual = random.chance(outliers)
                                ? random.uniform(-kGate, kGate)
                                : std::hypot(kRest, kRange * cosine) * random.normal();
    scan.push_back({residual, cosine});
  }
  return scan;
}

ResidualNoise learned(double outliers) {
  RandomStream random(1, "residual_noise");
  ResidualNoise noise;
  for (int i = 0; i < 200; ++i) noise.learn(drawn_scan(random, outliers));
  return noise;
}

/// Mean deviation of the residuals whose cosine lies between the bounds.
double deviation_between(double low, double high) {
  const double square = (high * high * high - low * low * low) / (3.0 * (high - low));
  return std::sqrt(kRest * kRest + kRange * kRange * square);
}

TEST(ResidualNoise, LearnsTheDeviationsOfGrazingAndFacingBeams) {
  const ResidualNoise noise = learned(0.0);
  EXPECT_NEAR(noise.sigma(0.0) / deviation_between(0.0, 0.4), 1.0, 0.1);
  EXPECT_NEAR(noise.sigma(1.0) / deviation_between(0.7, 1.0), 1.0, 0.1);
}

TEST(ResidualNoise, StatesTheDeviationAtEveryIncidence) {
  const ResidualNoise noise = learned(0.0);
  for (const double cosine : {0.2, 0.4, 0.6, 0.8, 1.0}) {
    EXPECT_NEAR(noise.sigma(cosine) / std::hypot(kRest, kRange * cosine), 1.0, 0.25) << cosine;
  }
}

// A median of magnitudes counts a fifth of outliers by a quarter; a mean square would triple.
TEST(ResidualNoise, AFifthOfMovingThingsHardlyCounts) {
  const ResidualNoise clean = learned(0.0);
  const ResidualNoise disturbed = learned(0.2);
  EXPECT_LT(disturbed.sigma(0.0), 1.35 * clean.sigma(0.0));
  EXPECT_LT(disturbed.sigma(1.0), 1.35 * clean.sigma(1.0));
  EXPECT_GT(disturbed.sigma(0.0), clean.sigma(0.0));
}

TEST(ResidualNoise, FewResidualsTeachNothing) {
  ResidualNoise noise;
  const double before = noise.sigma(1.0);
  for (int i = 0; i < 100; ++i) {
    noise.learn(std::vector<IncidentResidual>(19, {0.5, 1.0}));
    noise.learn(std::vector<IncidentResidual>(500, {0.5, 0.55}));  // neither grazing nor facing
  }
  EXPECT_EQ(noise.sigma(1.0), before);
}

TEST(ResidualNoise, IsNeverZeroAndNeverFallsWithTheCosine) {
  ResidualNoise noise;
  for (int i = 0; i < 500; ++i) {
    std::vector<IncidentResidual> scan(100, {0.0, 0.9});
    scan.insert(scan.end(), 100, {0.03, 0.1});
    noise.learn(scan);
  }
  EXPECT_GE(noise.sigma(1.0), 0.005);
  EXPECT_GE(noise.sigma(1.0), noise.sigma(0.0));
}

}  // namespace
}  // namespace aims
