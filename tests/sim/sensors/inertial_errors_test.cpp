// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/inertial_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace aims {
namespace {

constexpr double kInterval = 0.02;  ///< [s]

/// A triad with that error alone.
InertialTriad triad(const InertialErrorConfig& errors, RunSeeds seeds = 1) {
  return {errors, kInterval, 0.0, seeds, "test"};
}

InertialErrorConfig none() { return {.range = 1e3}; }

/// The answer to each unit vector as columns, without the answer to zero.
Eigen::Matrix3d response(const InertialErrorConfig& errors, bool to_force, RunSeeds seeds) {
  Eigen::Matrix3d columns;
  for (int axis = 0; axis < 3; ++axis) {
    InertialTriad device = triad(errors, seeds);
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis);
    const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
    columns.col(axis) = device.measure(0, to_force ? zero : unit, to_force ? unit : zero);
  }
  return columns;
}

TEST(InertialTriad, WithoutErrorsReturnsTheTruth) {
  const Eigen::Vector3d truth(1.0, -2.0, 0.3);
  EXPECT_EQ(triad(none()).measure(0, truth, truth), truth);
}

TEST(InertialTriad, MisalignmentIsAConstantShareOfEachAxisInTheOthers) {
  InertialErrorConfig errors = none();
  errors.misalignment = 0.01;
  double sum = 0.0;
  constexpr int kRuns = 200;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const Eigen::Matrix3d terms = response(errors, false, seed) - Eigen::Matrix3d::Identity();
    EXPECT_EQ(terms.diagonal().norm(), 0.0);
    sum += terms.squaredNorm() / 6.0;
  }
  EXPECT_NEAR(std::sqrt(sum / kRuns), 0.01, 0.0006);
  InertialTriad device = triad(errors);
  const Eigen::Vector3d first = device.measure(0, {1.0, 2.0, 3.0}, {});
  EXPECT_EQ(device.measure(0, {1.0, 2.0, 3.0}, {}), first);
  EXPECT_TRUE(device.measure(0, {2.0, 4.0, 6.0}, {}).isApprox(2.0 * first, 1e-12));
}

TEST(InertialTriad, ScaleAndAxesAreOfTheRobotAndTheTurnOnBiasOfTheRun) {
  InertialErrorConfig errors = none();
  errors.misalignment = errors.scale_error = 0.01;
  EXPECT_EQ(response(errors, false, {1, 7}), response(errors, false, {2, 7}));
  EXPECT_EQ(response(errors, false, {1, 7}), response(errors, false, 7));
  EXPECT_NE(response(errors, false, {1, 7}), response(errors, false, {1, 8}));
  errors = none();
  errors.turn_on_bias = 0.01;
  EXPECT_EQ(triad(errors, {1, 7}).bias(), triad(errors, {1, 8}).bias());
  EXPECT_NE(triad(errors, {1, 7}).bias(), triad(errors, {2, 7}).bias());
}

TEST(InertialTriad, GSensitivityAnswersToEachAxisOfTheSpecificForce) {
  InertialErrorConfig errors = none();
  errors.g_sensitivity = 2e-4;
  double sum = 0.0;
  constexpr int kRuns = 200;
  for (int seed = 1; seed <= kRuns; ++seed) {
    sum += response(errors, true, seed).squaredNorm() / 9.0;
  }
  EXPECT_NEAR(std::sqrt(sum / kRuns), 2e-4, 1.2e-5);
  const Eigen::Vector3d one = triad(errors).measure(0, {}, {0.0, 0.0, 9.81});
  EXPECT_TRUE(triad(errors).measure(0, {}, {0.0, 0.0, 19.62}).isApprox(2.0 * one, 1e-12));
}

TEST(InertialTriad, QuantizationRoundsToTheNearestStepAfterSaturation) {
  InertialErrorConfig errors = none();
  errors.resolution = 0.25;
  errors.range = 2.1;
  const Eigen::Vector3d value = triad(errors).measure(0, {0.37, -0.38, 5.0}, {});
  EXPECT_EQ(value, Eigen::Vector3d(0.25, -0.5, 2.0));
}

TEST(InertialTriad, NoiseAtAnInstantHasThePowerOfItsBandwidth) {
  // Of a density N, two-sided: variance 2 N^2 B, at any interval; without a filter N^2 / interval.
  InertialErrorConfig errors = none();
  errors.noise_density = 0.01;
  for (const double bandwidth : {0.0, 255.0}) {
    InertialTriad device(errors, kInterval, bandwidth, 3, "test");
    double sum = 0.0;
    constexpr int kSamples = 20'000;
    for (int i = 0; i < kSamples; ++i) sum += device.measure(0, {}, {}).squaredNorm() / 3.0;
    const double expected = bandwidth > 0.0 ? 1e-4 * 2.0 * bandwidth : 1e-4 / kInterval;
    EXPECT_NEAR(sum / kSamples, expected, 0.03 * expected) << bandwidth;
  }
}

TEST(InertialTriad, ReportsTheBiasThatIsInTheNextSample) {
  InertialErrorConfig errors = none();
  errors.turn_on_bias = 0.01;
  errors.bias_walk = 0.002;
  errors.drift = 0.02;
  errors.drift_time = 20.0;
  InertialTriad device = triad(errors);
  for (Time t = 0; t < 30 * kSecond; t += from_seconds(kInterval)) {
    const Eigen::Vector3d reported = device.bias();
    EXPECT_EQ(device.measure(t, {}, {}), reported);
  }
}

TEST(BiasDrift, HasItsStandardDeviationAndCorrelationTime) {
  double square = 0.0;
  double later = 0.0;
  constexpr int kRuns = 1000;
  for (int seed = 1; seed <= kRuns; ++seed) {
    BiasDrift drift(0.3, 50.0, seed, "test");
    const Eigen::Vector3d start = drift.at(7 * kSecond);
    const Eigen::Vector3d end = drift.at(57 * kSecond);
    square += end.squaredNorm() / 3.0;
    later += end.dot(start) / 3.0;
  }
  EXPECT_NEAR(square / kRuns, 0.09, 0.006);
  EXPECT_NEAR(later / square, std::exp(-1.0), 0.05) << "after one correlation time";
}

TEST(BiasDrift, DoesNotDependOnTheRateAtWhichItIsAsked) {
  BiasDrift slow(0.3, 50.0, 4, "test");
  BiasDrift fast(0.3, 50.0, 4, "test");
  slow.at(0);
  for (Time t = 0; t < 90 * kSecond; t += 2'500'000) fast.at(t);
  EXPECT_LT((fast.at(90 * kSecond) - slow.at(90 * kSecond)).norm(), 1e-12);
}

}  // namespace
}  // namespace aims
