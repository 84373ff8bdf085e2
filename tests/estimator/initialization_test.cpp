// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/initialization.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace aims {
namespace {

constexpr double kGravity = 9.81;

std::deque<ImuSample> standing(const Eigen::Quaterniond& R_world_body, const Eigen::Vector3d& bias,
                               int count) {
  std::deque<ImuSample> samples;
  for (int i = 0; i < count; ++i) {
    samples.push_back({(i + 1) * 20 * kMillisecond, bias,
                       R_world_body.conjugate() * Eigen::Vector3d(0.0, 0.0, kGravity)});
  }
  return samples;
}

TEST(Initialization, FindsTiltAndGyroBias) {
  const Eigen::Vector3d bias(0.01, -0.02, 0.03);
  const Eigen::Quaterniond tilt =
      so3_exp({0.0, 0.05, 0.0}) * so3_exp({-0.08, 0.0, 0.0});  // pitch, then roll: no yaw
  const auto initial = initialize(standing(tilt, bias, 110), InitializationConfig{}, kGravity);
  ASSERT_TRUE(initial.has_value());
  EXPECT_TRUE(initial->stood_still);
  EXPECT_EQ(initial->stamp, 2020 * kMillisecond);
  EXPECT_LT(initial->belief.state.rotation.angularDistance(tilt), 1e-9);
  EXPECT_LT((initial->belief.state.gyro_bias - bias).norm(), 1e-12);
  EXPECT_NEAR(yaw_of(initial->belief.state.rotation), 0.0, 1e-12);
  EXPECT_EQ(initial->belief.state.position.norm(), 0.0);
}

TEST(Initialization, WaitsForTheWholeStand) {
  const auto samples = standing(Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 30);
  EXPECT_FALSE(initialize(samples, InitializationConfig{}, kGravity).has_value());
  EXPECT_FALSE(initialize({}, InitializationConfig{}, kGravity).has_value());
}

TEST(Initialization, MotionEndsTheStand) {
  auto samples = standing(Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 80);
  samples.push_back({81 * 20 * kMillisecond, {0.0, 0.0, 1.0}, {0.0, 0.0, kGravity}});
  const auto initial = initialize(samples, InitializationConfig{}, kGravity);
  ASSERT_TRUE(initial.has_value());
  EXPECT_TRUE(initial->stood_still);
  EXPECT_EQ(initial->belief.state.gyro_bias.norm(), 0.0);
}

TEST(Initialization, AMovingStartLevelsByTheMeanForceAndLeavesTheVelocityOpen) {
  const Eigen::Quaterniond tilt = so3_exp({0.0, 0.06, 0.0});
  std::deque<ImuSample> samples;
  for (int i = 0; i < 60; ++i) {  // footfalls at 5 Hz and a swaying trunk
    const double phase = 2.0 * M_PI * i / 10.0;
    const Eigen::Vector3d footfall(1.5 * std::sin(phase), 0.5 * std::cos(phase),
                                   6.0 * std::cos(phase));
    samples.push_back({i * 20 * kMillisecond,
                       {0.0, 0.4 * std::cos(phase), 0.0},
                       tilt.conjugate() * Eigen::Vector3d(0.0, 0.0, kGravity) + footfall});
  }
  const auto initial = initialize(samples, InitializationConfig{}, kGravity);
  ASSERT_TRUE(initial.has_value());
  EXPECT_FALSE(initial->stood_still);
  EXPECT_EQ(initial->stamp, samples.back().stamp);
  EXPECT_LT(initial->belief.state.rotation.angularDistance(tilt), 1e-2);
  const ErrorVector variance = initial->belief.covariance.diagonal();
  EXPECT_GE(std::sqrt(segment(variance, ErrorState::kVelocity).minCoeff()), 0.7)
      << "the robot may be in full stride";
}

TEST(Initialization, MovingStartIsUncertain) {
  std::deque<ImuSample> samples;
  for (int i = 0; i < 60; ++i) {
    samples.push_back({i * 20 * kMillisecond, {0.0, 0.0, 1.0}, {0.0, 0.0, kGravity}});
  }
  const auto initial = initialize(samples, InitializationConfig{}, kGravity);
  ASSERT_TRUE(initial.has_value());
  EXPECT_FALSE(initial->stood_still);
}

}  // namespace
}  // namespace aims
