// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/leg_noise.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>

#include "sim/robot/robot_geometry.hpp"

namespace aims {
namespace {

const Eigen::Vector3d kForward(0.7, 0.02, -0.01);
const Eigen::Vector3d kTurning(0.05, -0.1, 0.3);

/// A robot on four fixed feet with legs of `geometry`, its base moving at kForward and kTurning.
LegOdometrySample fixed_stance(Time stamp, const LegGeometry& geometry = kRobotGeometry) {
  LegOdometrySample sample;
  sample.stamp = stamp;
  sample.linear_velocity = kForward;
  Eigen::Map<JointVector> position(sample.joint_position.data());
  Eigen::Map<JointVector> rate(sample.joint_velocity.data());
  for (int leg = 0; leg < kLegCount; ++leg) {
    const Eigen::Vector3d foot =
        hip_in_base(leg, geometry) + Eigen::Vector3d(0.02 * leg, side_of(leg) * 0.09, -0.29);
    const Eigen::Vector3d q = leg_angles(leg, foot, geometry);
    position.segment<3>(3 * leg) = q;
    rate.segment<3>(3 * leg) = foot_jacobian(leg, q, geometry).inverse() *
                               (-kForward - kTurning.cross(foot_in_base(leg, q, geometry)));
    sample.contact[leg] = true;
  }
  return sample;
}

/// The sample with the foot `leg` sliding over the ground at `velocity`, base axes [m/s].
LegOdometrySample slipping(LegOdometrySample sample, int leg, const Eigen::Vector3d& velocity) {
  const Eigen::Map<const JointVector> position(sample.joint_position.data());
  Eigen::Map<JointVector> rate(sample.joint_velocity.data());
  rate.segment<3>(3 * leg) +=
      foot_jacobian(leg, joints_of(position, leg), kRobotGeometry).inverse() * velocity;
  return sample;
}

SensorRig rig() { return {.leg_geometry = kRobotGeometry}; }

Eigen::Matrix3d nominal(const LegNoiseConfig& config) {
  return config.velocity_sigma.cwiseAbs2().asDiagonal();
}

TEST(LegNoise, FixedFeetGiveOneVelocity) {
  const StanceFeet stance = compare_stance_feet(fixed_stance(0), kTurning, kRobotGeometry);
  EXPECT_TRUE(stance.measured);
  EXPECT_EQ(stance.count, 4);
  EXPECT_LT(stance.spread.norm(), 1e-6);
}

TEST(LegNoise, ASlippingFootRaisesTheSpread) {
  LegOdometrySample sample = slipping(fixed_stance(0), 1, {0.3, 0.0, 0.0});
  // Deviations of {0.3, 0, 0, 0}: sqrt(3 (0.3 / 4)^2 + (0.9 / 4)^2) / sqrt(3) = 0.15.
  EXPECT_NEAR(compare_stance_feet(sample, kTurning, kRobotGeometry).spread.x(), 0.15, 1e-9);
  EXPECT_NEAR(compare_stance_feet(sample, kTurning, kRobotGeometry).spread.y(), 0.0, 1e-9);
  sample.contact[1] = false;
  EXPECT_LT(compare_stance_feet(sample, kTurning, kRobotGeometry).spread.norm(), 1e-6)
      << "feet in the air are left out";
}

TEST(LegNoise, WrongLegLengthsDoNotRaiseTheSpread) {
  LegGeometry longer = kRobotGeometry;
  longer.thigh *= 1.1;
  longer.calf *= 1.1;
  const LegNoiseConfig config;
  const StanceFeet stance = compare_stance_feet(fixed_stance(0, longer), kTurning, kRobotGeometry);
  EXPECT_LT(stance.spread.maxCoeff(), config.nominal_spread);
}

TEST(LegNoise, AnotherRobotNeedsItsOwnGeometryFromTheRig) {
  SensorRig other = rig();
  other.leg_geometry.thigh = 0.3;
  other.leg_geometry.hip_y = 0.15;
  const LegOdometrySample sample = fixed_stance(0, other.leg_geometry);
  EXPECT_LT(compare_stance_feet(sample, kTurning, other.leg_geometry).spread.norm(), 1e-6);
  EXPECT_GT(compare_stance_feet(sample, kTurning, kRobotGeometry).spread.norm(), 0.02);
  const LegNoiseConfig config{.nominal_spread = 0.0};
  const Eigen::Matrix3d own = LegNoiseModel(config, other).noise(sample, kTurning);
  const Eigen::Matrix3d wrong = LegNoiseModel(config, rig()).noise(sample, kTurning);
  const Eigen::Matrix3d nominal_noise =
      LegNoiseModel(config, rig()).noise(fixed_stance(0), kTurning);
  EXPECT_TRUE(own.isApprox(nominal_noise, 1e-6));
  EXPECT_GT(wrong.trace(), 1.02 * own.trace());
}

TEST(LegNoise, AFixedStanceHasNominalNoise) {
  const LegNoiseConfig config;
  StanceFeet stance = compare_stance_feet(fixed_stance(0), kTurning, kRobotGeometry);
  EXPECT_TRUE(sample_covariance(config, stance, {}).isApprox(nominal(config)));
  stance.count = 2;
  EXPECT_TRUE(sample_covariance(config, stance, {}).isApprox(nominal(config)))
      << "two feet of a trot";
}

TEST(LegNoise, WithoutJointsTheNoiseIsNominal) {
  const LegNoiseConfig config;
  const StanceFeet stance = compare_stance_feet(LegOdometrySample{}, kTurning, kRobotGeometry);
  EXPECT_FALSE(stance.measured);
  EXPECT_TRUE(sample_covariance(config, stance, {}).isApprox(nominal(config)));
  LegOdometrySample broken = fixed_stance(0);
  broken.joint_velocity[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(compare_stance_feet(broken, kTurning, kRobotGeometry).measured);
}

TEST(LegNoise, NoiseGrowsWithSlipMissingFeetTurningAndGaps) {
  const LegNoiseConfig config;
  const StanceFeet fixed = compare_stance_feet(fixed_stance(0), kTurning, kRobotGeometry);
  const StanceFeet slip =
      compare_stance_feet(slipping(fixed_stance(0), 2, {0.6, 0.0, 0.0}), kTurning, kRobotGeometry);
  const Eigen::Vector3d growth = (sample_covariance(config, slip, {}) - nominal(config)).diagonal();
  EXPECT_NEAR(growth.x(), 0.3 * 0.3 - config.nominal_spread * config.nominal_spread, 1e-9);
  EXPECT_NEAR(growth.y(), 0.0, 1e-9) << "the foot slips forward only";
  const auto grown = [&](const StanceFeet& stance, const LegConditions& conditions) {
    return (sample_covariance(config, stance, conditions) - nominal(config)).diagonal().minCoeff();
  };
  const StanceFeet one_foot{true, 1, Eigen::Vector3d::Zero()};
  const StanceFeet none{true, 0, Eigen::Vector3d::Zero()};
  EXPECT_GT(grown(one_foot, {}), 0.0);
  EXPECT_GT(grown(none, {}), grown(one_foot, {}));
  EXPECT_GT(grown(fixed, {.yaw_rate = -0.9}), 0.0);
  EXPECT_GT(grown(fixed, {.gap = 0.5}), 0.0);
  EXPECT_LE(grown(fixed, {.gap = 1e6}), 1.001 * kNoFootSigma * kNoFootSigma);
}

TEST(LegNoise, TheGateInflatesBeforeItRejects) {
  EXPECT_EQ(gate_inflation(0.99 * kLegGate), 1.0);
  EXPECT_NEAR(gate_inflation(4.0 * kLegGate).value(), 4.0, 1e-12);
  EXPECT_FALSE(gate_inflation(1.01 * kMaxVarianceGrowth * kLegGate).has_value());
  EXPECT_FALSE(gate_inflation(std::numeric_limits<double>::quiet_NaN()).has_value());
}

TEST(LegNoise, APacketAfterAGapHasMoreNoise) {
  LegNoiseModel model(LegNoiseConfig{}, rig());
  const Eigen::Matrix3d first = model.noise(fixed_stance(0), kTurning);
  const Eigen::Matrix3d next = model.noise(fixed_stance(5 * kMillisecond), kTurning);
  const Eigen::Matrix3d late = model.noise(fixed_stance(2 * kSecond), kTurning);
  EXPECT_TRUE(next.isApprox(first));
  EXPECT_GT(late(0, 0), 1.2 * next(0, 0));
}

TEST(LegNoise, AShortSlipIsInflatedAndALastingInnovationAccepted) {
  const LegNoiseConfig config;
  LegNoiseModel model(config, rig());
  LinearMeasurement measurement;
  columns(measurement.jacobian, ErrorState::kVelocity).setIdentity();
  const ErrorMatrix covariance = 1e-4 * ErrorMatrix::Identity();
  const double ten_sigma = 10.0 * config.velocity_sigma.x();
  double during_slip = 0.0;
  double in_the_end = 0.0;
  for (Time t = 0; t < kSecond; t += 5 * kMillisecond) {
    measurement.noise = model.noise(fixed_stance(t), kTurning);
    measurement.residual = Eigen::Vector3d(t > 100 * kMillisecond ? ten_sigma : 0.01, 0.0, 0.0);
    const auto inflation = model.inflation(measurement, covariance);
    ASSERT_TRUE(inflation.has_value());
    if (t <= 100 * kMillisecond) {
      EXPECT_EQ(*inflation, 1.0);
    }
    if (t == 200 * kMillisecond) during_slip = *inflation;
    in_the_end = *inflation;
  }
  EXPECT_GT(during_slip, 3.0);
  EXPECT_EQ(in_the_end, 1.0);
}

}  // namespace
}  // namespace aims
