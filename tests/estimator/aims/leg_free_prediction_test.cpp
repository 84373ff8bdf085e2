// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/leg_free_prediction.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace aims {
namespace {

using E = ErrorState;

/// Samples at rest, level, at 50 Hz over `seconds`.
ImuHistory rest(const ImuPropagationConfig& config, double seconds) {
  ImuHistory imu(config, 50.0);
  for (double t = 0.02; t < seconds + 0.01; t += 0.02) {
    ImuSample sample;
    sample.stamp = from_seconds(t);
    sample.specific_force = {0.0, 0.0, config.gravity};
    imu.insert(sample);
  }
  return imu;
}

TEST(LegFreePrediction, IsEmptyBeforeTheFirstScan) {
  const ImuPropagationConfig config;
  LegFreePrediction prediction(config);
  prediction.predict_to(kSecond, rest(config, 1.0));
  EXPECT_EQ(prediction.belief(), nullptr);
}

TEST(LegFreePrediction, PropagatesTheLastBeliefByTheImuAlone) {
  const ImuPropagationConfig config;
  const ImuHistory imu = rest(config, 0.5);
  Belief belief;
  belief.state.velocity = {0.7, 0.0, 0.0};
  belief.covariance = 1e-6 * ErrorMatrix::Identity();
  block(belief.covariance, E::kVelocity, E::kVelocity) = 0.04 * Eigen::Matrix3d::Identity();
  LegFreePrediction prediction(config);
  prediction.restart(belief, 0);
  prediction.predict_to(from_seconds(0.2), imu);
  prediction.predict_to(from_seconds(0.5), imu);
  ASSERT_NE(prediction.belief(), nullptr);
  EXPECT_NEAR(prediction.belief()->state.position.x(), 0.35, 1e-9);
  // A velocity variance of 0.04 m^2/s^2 over 0.5 s; noise and tilt add little.
  const int x = E::kPosition.offset;
  EXPECT_NEAR(prediction.belief()->covariance(x, x), 0.04 * 0.25, 3e-4);
  prediction.restart(belief, from_seconds(0.5));
  EXPECT_EQ(prediction.belief()->state.position.x(), 0.0);
}

TEST(LidarConsistency, OfAShiftAlongOneAxisIsItsSquareOverTheVariance) {
  Belief prediction;
  prediction.covariance = 0.01 * ErrorMatrix::Identity();
  NominalState lidar;
  lidar.position.y() = 0.3;
  EXPECT_NEAR(lidar_consistency(lidar, prediction), 0.09 / 0.01, 1e-12);
}

TEST(LidarConsistency, OfAnUpdateIsTheSquaredGainTimesThatOfTheMeasurement) {
  constexpr double kVariance = 0.01;
  constexpr double kInformation = 300.0;
  constexpr double kShift = 0.2;
  Belief prediction;
  prediction.covariance = kVariance * ErrorMatrix::Identity();
  Matrix6 A = Matrix6::Zero();
  A(3, 3) = kInformation;
  Vector6 b = Vector6::Zero();
  b[3] = -kInformation * kShift;  // of the residual p - shift
  const Belief lidar = fuse(prediction, prediction.state, {A, b});
  const double gain = kInformation / (kInformation + 1.0 / kVariance);
  EXPECT_NEAR(lidar_consistency(lidar.state, prediction), gain * gain * kShift * kShift / kVariance,
              1e-9);
}

}  // namespace
}  // namespace aims
