// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/initialization.hpp"

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

std::optional<InitialBelief> quietly(const std::deque<ImuSample>& samples) {
  return initialize_quietly(samples, InitializationConfig{}, StartConfig{}, kGravity);
}

/// The samples with a force [m/s^2] from the side added in [begin, end) [s].
std::deque<ImuSample> shoved(std::deque<ImuSample> samples, double begin, double end,
                             double force) {
  for (ImuSample& sample : samples) {
    const double t = to_seconds(sample.stamp);
    if (t >= begin && t < end) sample.specific_force.y() += force;
  }
  return samples;
}

TEST(QuietInitialization, EqualsThePlainOneOfAnUndisturbedStandOnSlopes) {
  for (const double slope_deg : {0.0, 5.0, 10.0, 15.0}) {
    const double slope = slope_deg * M_PI / 180.0;
    for (const Eigen::Vector3d& axis :
         {Eigen::Vector3d(Eigen::Vector3d::UnitX()), Eigen::Vector3d(Eigen::Vector3d::UnitY())}) {
      const auto samples = standing(so3_exp(slope * axis), {0.01, 0.0, -0.01}, 110);
      const auto plain = initialize(samples, InitializationConfig{}, kGravity);
      const auto quiet = quietly(samples);
      ASSERT_TRUE(plain && quiet);
      EXPECT_TRUE(quiet->stood_still);
      EXPECT_EQ(quiet->stamp, samples.back().stamp);
      EXPECT_LT(quiet->belief.state.rotation.angularDistance(so3_exp(slope * axis)), 1e-6);
      EXPECT_LT(plain->belief.state.rotation.angularDistance(so3_exp(slope * axis)), 1e-6);
    }
  }
}

TEST(QuietInitialization, AShoveFromTheSideIsNoTilt) {
  const auto level = standing(Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 101);
  const auto samples = shoved(level, 1.2, 1.6, 2.0);  // changes the force's size by 2 % only
  const auto plain = initialize(samples, InitializationConfig{}, kGravity);
  const auto quiet = quietly(samples);
  ASSERT_TRUE(plain && quiet);
  EXPECT_GT(plain->belief.state.rotation.angularDistance(Eigen::Quaterniond::Identity()), 0.04);
  EXPECT_LT(quiet->belief.state.rotation.angularDistance(Eigen::Quaterniond::Identity()), 1e-6);
  EXPECT_LT(quiet->stamp, from_seconds(1.21)) << "the shove is propagated, not averaged";
}

TEST(QuietInitialization, AShortRestTellsTheTiltButNoBias) {
  // Between two shoves the body sways back for 0.4 s, slowly and evenly.
  const Eigen::Quaterniond tilt = so3_exp(Eigen::Vector3d(0.02, 0.0, 0.0));
  auto samples = standing(tilt, {0.04, 0.0, 0.0}, 56);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t = to_seconds(samples[i].stamp);
    if (t < 0.7 || t > 1.1) samples[i].specific_force.y() += i % 2 == 0 ? 2.0 : -2.0;
  }
  const auto quiet = quietly(samples);
  ASSERT_TRUE(quiet);
  EXPECT_TRUE(quiet->stood_still);
  EXPECT_LT(quiet->belief.state.rotation.angularDistance(tilt), 1e-6);
  EXPECT_EQ(quiet->belief.state.gyro_bias.norm(), 0.0);
  const ErrorVector variance = quiet->belief.covariance.diagonal();
  EXPECT_NEAR(std::sqrt(segment(variance, ErrorState::kGyroBias).minCoeff()),
              10.0 * InitializationConfig{}.sigma_gyro_bias, 1e-12);
}

TEST(QuietInitialization, AShoveBeforeTheStandIsLeftOut) {
  const auto level = standing(Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 101);
  const auto samples = shoved(level, 0.0, 0.55, 2.0);
  const auto quiet = quietly(samples);
  ASSERT_TRUE(quiet);
  EXPECT_TRUE(quiet->stood_still);
  EXPECT_EQ(quiet->stamp, samples.back().stamp);
  EXPECT_LT(quiet->belief.state.rotation.angularDistance(Eigen::Quaterniond::Identity()), 1e-6);
}

TEST(QuietInitialization, WithoutAQuietStretchTheStartIsAMovingOne) {
  auto samples = standing(Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 101);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].specific_force.y() += i % 2 == 0 ? 2.0 : -2.0;
  }
  const auto quiet = quietly(samples);
  ASSERT_TRUE(quiet);
  EXPECT_FALSE(quiet->stood_still);
  const ErrorVector variance = quiet->belief.covariance.diagonal();
  EXPECT_GE(std::sqrt(segment(variance, ErrorState::kVelocity).minCoeff()), 0.7);
}

}  // namespace
}  // namespace aims
