// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/static_initialization.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "core/random.hpp"

namespace aims {
namespace {

constexpr double kGravity = 9.81;

std::vector<ImuSample> standing(const Eigen::Quaterniond& R_world_body, const Eigen::Vector3d& bias,
                                int count) {
  std::vector<ImuSample> samples;
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

TEST(Initialization, WaitsForTheFullDuration) {
  const auto samples = standing(Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 30);
  EXPECT_FALSE(initialize(samples, InitializationConfig{}, kGravity).has_value());
  EXPECT_FALSE(initialize({}, InitializationConfig{}, kGravity).has_value());
}

TEST(Initialization, MotionEndsTheStandingStart) {
  auto samples = standing(Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 80);
  samples.push_back({81 * 20 * kMillisecond, {0.0, 0.0, 1.0}, {0.0, 0.0, kGravity}});
  const auto initial = initialize(samples, InitializationConfig{}, kGravity);
  ASSERT_TRUE(initial.has_value());
  EXPECT_TRUE(initial->stood_still);
  EXPECT_EQ(initial->belief.state.gyro_bias.norm(), 0.0);
}

TEST(Initialization, AMovingStartTakesTiltFromTheMeanForceAndLeavesTheVelocityUnknown) {
  const Eigen::Quaterniond tilt = so3_exp({0.0, 0.06, 0.0});
  std::vector<ImuSample> samples;
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
  std::vector<ImuSample> samples;
  for (int i = 0; i < 60; ++i) {
    samples.push_back({i * 20 * kMillisecond, {0.0, 0.0, 1.0}, {0.0, 0.0, kGravity}});
  }
  const auto initial = initialize(samples, InitializationConfig{}, kGravity);
  ASSERT_TRUE(initial.has_value());
  EXPECT_FALSE(initial->stood_still);
}

/// Squared errors of a start over their stated variances.
struct TiltErrors {
  double tilt_and_bias = 0.0;   ///< of tilt and accelerometer bias, 5 dof
  double corrected_tilt = 0.0;  ///< of the tilt once the bias is known, 2 dof
};

/// A start whose bias and error of the mean force are drawn from the configuration.
TiltErrors errors_of_a_start(RandomStream& random, bool moving) {
  using State = ErrorState;
  const InitializationConfig config;
  const Eigen::Quaterniond tilt =
      so3_exp({0.0, 0.05 * random.normal(), 0.0}) * so3_exp({0.05 * random.normal(), 0.0, 0.0});
  const Eigen::Vector3d bias = config.sigma_accelerometer_bias * random.normal3();
  const double sigma = moving ? kSigmaMeanForceMoving : kSigmaMeanForce;
  auto samples = standing(tilt, Eigen::Vector3d::Zero(), 110);
  const Eigen::Vector3d error = bias + sigma * random.normal3();
  for (ImuSample& sample : samples) {
    sample.specific_force += error;
    if (moving) sample.angular_velocity.z() = 1.0;
  }
  const Belief belief = initialize(samples, config, kGravity)->belief;
  // R_true = R_hat Exp(d): true_up = up + up x d for the horizontal part of d; yaw has no error.
  const Eigen::Vector3d up = belief.state.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d true_up = tilt.conjugate() * Eigen::Vector3d::UnitZ();
  Vector6 d;
  d << true_up.cross(up), bias - belief.state.accelerometer_bias;
  Matrix6 P;
  P << block(belief.covariance, State::kRotation, State::kRotation),
      block(belief.covariance, State::kRotation, State::kAccelerometerBias),
      block(belief.covariance, State::kAccelerometerBias, State::kRotation),
      block(belief.covariance, State::kAccelerometerBias, State::kAccelerometerBias);
  Eigen::Matrix<double, 3, 6> correction;
  correction << Eigen::Matrix3d::Identity(), -hat(up) / kGravity;
  const Eigen::Vector3d corrected = correction * d;
  const Eigen::Matrix3d covariance = correction * P * correction.transpose();
  return {d.dot(P.llt().solve(d)), corrected.dot(covariance.llt().solve(corrected))};
}

TEST(Initialization, TheCovarianceOfTiltAndBiasIsThatOfTheirErrors) {
  constexpr int kDraws = 4000;
  for (const bool moving : {false, true}) {
    RandomStream random(21, "tilt_and_bias");
    TiltErrors sum;
    for (int draw = 0; draw < kDraws; ++draw) {
      const TiltErrors errors = errors_of_a_start(random, moving);
      sum.tilt_and_bias += errors.tilt_and_bias;
      sum.corrected_tilt += errors.corrected_tilt;
    }
    EXPECT_NEAR(sum.tilt_and_bias / kDraws, 5.0, 0.25)
        << (moving ? "moving" : "standing") << ", seed 21";
    EXPECT_NEAR(sum.corrected_tilt / kDraws, 2.0, 0.15)
        << (moving ? "moving" : "standing") << ", seed 21";
  }
}

std::optional<InitialBelief> run_static(std::span<const ImuSample> samples) {
  return initialize_static(samples, InitializationConfig{}, kGravity);
}

/// The samples with a force [m/s^2] from the side added in [begin, end) [s].
std::vector<ImuSample> pushed(std::vector<ImuSample> samples, double begin, double end,
                              double force) {
  for (ImuSample& sample : samples) {
    const double t = to_seconds(sample.stamp);
    if (t >= begin && t < end) sample.specific_force.y() += force;
  }
  return samples;
}

TEST(StaticInitialization, EqualsTheFixedIntervalForAnUndisturbedStartOnSlopes) {
  for (const double slope_deg : {0.0, 5.0, 10.0, 15.0}) {
    const double slope = slope_deg * M_PI / 180.0;
    for (const Eigen::Vector3d& axis :
         {Eigen::Vector3d(Eigen::Vector3d::UnitX()), Eigen::Vector3d(Eigen::Vector3d::UnitY())}) {
      const auto samples = standing(so3_exp(slope * axis), {0.01, 0.0, -0.01}, 110);
      const auto plain = initialize(samples, InitializationConfig{}, kGravity);
      const auto found = run_static(samples);
      ASSERT_TRUE(plain && found);
      EXPECT_TRUE(found->stood_still);
      EXPECT_EQ(found->stamp, samples.back().stamp);
      EXPECT_LT(found->belief.state.rotation.angularDistance(so3_exp(slope * axis)), 1e-6);
      EXPECT_LT(plain->belief.state.rotation.angularDistance(so3_exp(slope * axis)), 1e-6);
    }
  }
}

// The estimator asks at each sample; one noisy pair of samples where the mean begins is no motion.
TEST(StaticInitialization, NoiseIsNoMotionAtAnySampleOfAStart) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream random = rng(seed, "imu");
    std::vector<ImuSample> samples;
    std::optional<InitialBelief> initial;
    while (!initial && samples.size() < 1000) {
      samples.push_back({static_cast<Time>(samples.size()) * (kSecond / 400),
                         0.02 * random.normal3(),
                         Eigen::Vector3d(0.0, 0.0, kGravity) + 0.13 * random.normal3()});
      initial = run_static(samples);
    }
    ASSERT_TRUE(initial);
    EXPECT_TRUE(initial->stood_still) << "seed " << seed << ", " << samples.size() << " samples";
  }
}

TEST(StaticInitialization, ALateralPushIsNotTakenAsTilt) {
  const auto level = standing(Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 101);
  const auto samples = pushed(level, 1.2, 1.6, 2.0);  // changes the magnitude by 2 % only
  const auto plain = initialize(samples, InitializationConfig{}, kGravity);
  const auto found = run_static(samples);
  ASSERT_TRUE(plain && found);
  EXPECT_GT(plain->belief.state.rotation.angularDistance(Eigen::Quaterniond::Identity()), 0.04);
  EXPECT_LT(found->belief.state.rotation.angularDistance(Eigen::Quaterniond::Identity()), 1e-6);
  EXPECT_LT(found->stamp, from_seconds(1.21)) << "the push is propagated, not averaged";
}

TEST(StaticInitialization, AShortIntervalGivesTheTiltButNoGyroBias) {
  // Between two pushes the body sways back for 0.4 s, slowly and evenly.
  const Eigen::Quaterniond tilt = so3_exp(Eigen::Vector3d(0.02, 0.0, 0.0));
  auto samples = standing(tilt, {0.04, 0.0, 0.0}, 56);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t = to_seconds(samples[i].stamp);
    if (t < 0.7 || t > 1.1) samples[i].specific_force.y() += i % 10 < 5 ? 2.0 : -2.0;
  }
  const auto found = run_static(samples);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->stood_still);
  EXPECT_LT(found->belief.state.rotation.angularDistance(tilt), 1e-6);
  EXPECT_EQ(found->belief.state.gyro_bias.norm(), 0.0);
  const ErrorVector variance = found->belief.covariance.diagonal();
  EXPECT_NEAR(std::sqrt(segment(variance, ErrorState::kGyroBias).minCoeff()),
              10.0 * InitializationConfig{}.sigma_gyro_bias, 1e-12);
}

TEST(StaticInitialization, AShortStandingTimeIsStillAStart) {
  const auto samples = standing(Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 101);
  const InitializationConfig config = {.duration = 0.5};
  const auto found = initialize_static(samples, config, 9.81);
  ASSERT_TRUE(found);
  EXPECT_LT(found->belief.state.rotation.angularDistance(Eigen::Quaterniond::Identity()), 1e-6);
}

TEST(StaticInitialization, APushBeforeTheIntervalIsLeftOut) {
  const auto level = standing(Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 101);
  const auto samples = pushed(level, 0.0, 0.55, 2.0);
  const auto found = run_static(samples);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->stood_still);
  EXPECT_EQ(found->stamp, samples.back().stamp);
  EXPECT_LT(found->belief.state.rotation.angularDistance(Eigen::Quaterniond::Identity()), 1e-6);
}

TEST(StaticInitialization, WithoutAStaticIntervalTheStartIsMoving) {
  auto samples = standing(Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 101);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].specific_force.y() += i % 10 < 5 ? 2.0 : -2.0;
  }
  const auto found = run_static(samples);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->stood_still);
  const ErrorVector variance = found->belief.covariance.diagonal();
  EXPECT_GE(std::sqrt(segment(variance, ErrorState::kVelocity).minCoeff()), 0.7);
}

}  // namespace
}  // namespace aims
