// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/leg_evidence.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>

namespace aims {
namespace {

const Eigen::Vector3d kForward(0.7, 0.02, -0.01);
const Eigen::Vector3d kTurning(0.05, -0.1, 0.3);

/// A robot on four firm feet with legs of `geometry`, its base moving at kForward and kTurning.
LegOdometrySample firm_stance(Time stamp, const LegGeometry& geometry = kLegGeometry) {
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

/// The sample with the foot `leg` sliding over the floor at `velocity`, base axes [m/s].
LegOdometrySample slipping(LegOdometrySample sample, int leg, const Eigen::Vector3d& velocity) {
  const Eigen::Map<const JointVector> position(sample.joint_position.data());
  Eigen::Map<JointVector> rate(sample.joint_velocity.data());
  rate.segment<3>(3 * leg) += foot_jacobian(leg, joints_of(position, leg)).inverse() * velocity;
  return sample;
}

Eigen::Matrix3d nominal(const LegEvidenceConfig& config) {
  return config.velocity_sigma.cwiseAbs2().asDiagonal();
}

TEST(LegEvidence, FirmFeetTellOneVelocity) {
  const StanceEvidence stance = compare_feet(firm_stance(0), kTurning);
  EXPECT_TRUE(stance.told);
  EXPECT_EQ(stance.standing, 4);
  EXPECT_LT(stance.spread.norm(), 1e-6);
}

TEST(LegEvidence, ASlippingFootIsTheSpread) {
  LegOdometrySample sample = slipping(firm_stance(0), 1, {0.3, 0.0, 0.0});
  // Deviations of {0.3, 0, 0, 0}: sqrt(3 (0.3 / 4)^2 + (0.9 / 4)^2) / sqrt(3) = 0.15.
  EXPECT_NEAR(compare_feet(sample, kTurning).spread.x(), 0.15, 1e-9);
  EXPECT_NEAR(compare_feet(sample, kTurning).spread.y(), 0.0, 1e-9);
  sample.contact[1] = false;
  EXPECT_LT(compare_feet(sample, kTurning).spread.norm(), 1e-6) << "a foot in the air says nothing";
}

TEST(LegEvidence, WrongLengthsOfTheLegsLookFirm) {
  LegGeometry longer;
  longer.thigh *= 1.1;
  longer.calf *= 1.1;
  const LegEvidenceConfig config;
  const StanceEvidence stance = compare_feet(firm_stance(0, longer), kTurning);
  EXPECT_LT(stance.spread.maxCoeff(), config.nominal_spread);
}

TEST(LegEvidence, AFirmStanceHasNominalNoise) {
  const LegEvidenceConfig config;
  StanceEvidence stance = compare_feet(firm_stance(0), kTurning);
  EXPECT_TRUE(evident_variance(config, stance, {}).isApprox(nominal(config)));
  stance.standing = 2;
  EXPECT_TRUE(evident_variance(config, stance, {}).isApprox(nominal(config)))
      << "two feet of a trot";
}

TEST(LegEvidence, WithoutJointsTheNoiseIsNominal) {
  const LegEvidenceConfig config;
  const StanceEvidence stance = compare_feet(LegOdometrySample{}, kTurning);
  EXPECT_FALSE(stance.told);
  EXPECT_TRUE(evident_variance(config, stance, {}).isApprox(nominal(config)));
  LegOdometrySample broken = firm_stance(0);
  broken.joint_velocity[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(compare_feet(broken, kTurning).told);
}

TEST(LegEvidence, NoiseGrowsWithEachDoubt) {
  const LegEvidenceConfig config;
  const StanceEvidence firm = compare_feet(firm_stance(0), kTurning);
  const StanceEvidence slip = compare_feet(slipping(firm_stance(0), 2, {0.3, 0.0, 0.0}), kTurning);
  const Eigen::Vector3d growth = (evident_variance(config, slip, {}) - nominal(config)).diagonal();
  EXPECT_NEAR(growth.x(), 0.15 * 0.15 - config.nominal_spread * config.nominal_spread, 1e-9);
  EXPECT_NEAR(growth.y(), 0.0, 1e-9) << "the foot slips forward only";
  const auto grown = [&](const StanceEvidence& stance, const LegCircumstances& circumstances) {
    return (evident_variance(config, stance, circumstances) - nominal(config))
        .diagonal()
        .minCoeff();
  };
  const StanceEvidence one_foot{true, 1, Eigen::Vector3d::Zero()};
  const StanceEvidence none{true, 0, Eigen::Vector3d::Zero()};
  EXPECT_GT(grown(one_foot, {}), 0.0);
  EXPECT_GT(grown(none, {}), grown(one_foot, {}));
  EXPECT_GT(grown(firm, {.yaw_rate = -0.9}), 0.0);
  EXPECT_GT(grown(firm, {.gap = 0.5}), 0.0);
  EXPECT_LE(grown(firm, {.gap = 1e6}), 1.001 * config.no_foot_sigma * config.no_foot_sigma);
}

TEST(LegEvidence, TheGateInflatesBeforeItDrops) {
  LegEvidenceConfig config;
  config.gate = 10.0;
  config.drop = 8.0;
  EXPECT_EQ(gate_inflation(config, 9.9), 1.0);
  EXPECT_NEAR(gate_inflation(config, 40.0).value(), 4.0, 1e-12);
  EXPECT_FALSE(gate_inflation(config, 81.0).has_value());
  EXPECT_FALSE(gate_inflation(config, std::numeric_limits<double>::quiet_NaN()).has_value());
}

TEST(LegEvidence, APacketAfterAGapWeighsLess) {
  LegEvidence evidence(LegEvidenceConfig{}, LegConfig{});
  const Eigen::Matrix3d first = evidence.noise(firm_stance(0), kTurning);
  const Eigen::Matrix3d next = evidence.noise(firm_stance(5 * kMillisecond), kTurning);
  const Eigen::Matrix3d late = evidence.noise(firm_stance(2 * kSecond), kTurning);
  EXPECT_TRUE(next.isApprox(first));
  EXPECT_GT(late(0, 0), 1.2 * next(0, 0));
}

TEST(LegEvidence, ABurstIsDampedAndALastingDisagreementBelieved) {
  const LegEvidenceConfig config;
  LegEvidence evidence(config, LegConfig{});
  LinearMeasurement measurement;
  columns(measurement.jacobian, ErrorState::kVelocity).setIdentity();
  const ErrorMatrix covariance = 1e-4 * ErrorMatrix::Identity();
  const double ten_sigma = 10.0 * config.velocity_sigma.x();
  double in_burst = 0.0;
  double in_the_end = 0.0;
  for (Time t = 0; t < kSecond; t += 5 * kMillisecond) {
    measurement.noise = evidence.noise(firm_stance(t), kTurning);
    measurement.residual = Eigen::Vector3d(t > 100 * kMillisecond ? ten_sigma : 0.01, 0.0, 0.0);
    const auto inflation = evidence.inflation(measurement, covariance);
    ASSERT_TRUE(inflation.has_value());
    if (t <= 100 * kMillisecond) {
      EXPECT_EQ(*inflation, 1.0);
    }
    if (t == 200 * kMillisecond) in_burst = *inflation;
    in_the_end = *inflation;
  }
  EXPECT_GT(in_burst, 3.0);
  EXPECT_EQ(in_the_end, 1.0);
}

}  // namespace
}  // namespace aims
