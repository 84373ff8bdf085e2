// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/zero_velocity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/random.hpp"

namespace aims {
namespace {

constexpr Duration kImuPeriod = 20 * kMillisecond;
constexpr Duration kLegPeriod = 5 * kMillisecond;
const Eigen::Vector3d kBias(0.01, -0.02, 0.005);

/// A robot at rest; the functions modify the samples at a time [s].
struct Rig {
  std::function<void(double, ImuSample&)> imu = [](double, ImuSample&) {};
  std::function<void(double, LegOdometrySample&)> legs = [](double, LegOdometrySample&) {};
};

struct Outcome {
  int standing = 0;      ///< samples detected as standing
  int measurements = 0;  ///< due measurements
  double first = -1.0;   ///< time of the first such sample [s]
};

Outcome observe(const Rig& rig, double seconds = 3.0) {
  RandomStream random(7, "standstill.test");
  ZeroVelocityDetector detector;
  std::vector<ImuSample> imu;
  Outcome outcome;
  for (Time t = 0; t < from_seconds(seconds); t += kLegPeriod) {
    if (t % kImuPeriod == 0) {
      ImuSample sample{t, kBias + 1e-3 * random.normal3(),
                       Eigen::Vector3d(0.1, 0.0, 9.81) + 0.02 * random.normal3()};
      rig.imu(to_seconds(t), sample);
      imu.push_back(sample);
    }
    LegOdometrySample legs;
    legs.stamp = t;
    legs.contact.fill(true);
    legs.joint_position.fill(0.5);
    for (double& rate : legs.joint_velocity) rate = 0.05 * random.normal();
    legs.linear_velocity = 0.01 * random.normal3();
    rig.legs(to_seconds(t), legs);
    const bool standing = detector.update(legs, imu, kBias);
    outcome.standing += standing;
    outcome.measurements += detector.due_measurement().has_value();
    if (standing && outcome.first < 0.0) outcome.first = to_seconds(t);
  }
  return outcome;
}

TEST(ZeroVelocity, DetectsAfterOneWindowAndMeasuresOncePerWindow) {
  const Outcome outcome = observe({});
  EXPECT_GE(outcome.first, to_seconds(kStandingWindow));
  EXPECT_LT(outcome.first, 1.0);
  EXPECT_GT(outcome.standing, 400);
  EXPECT_GE(outcome.measurements, 6);
  EXPECT_LE(outcome.measurements, 10);
}

TEST(ZeroVelocity, WithoutJointsUsesTheLegSpeed) {
  Rig rig;
  rig.legs = [](double, LegOdometrySample& legs) {
    legs.contact.fill(false);
    legs.joint_position.fill(0.0);
    legs.joint_velocity.fill(0.0);
  };
  EXPECT_GT(observe(rig).standing, 400);
  rig.legs = [legs = rig.legs](double, LegOdometrySample& sample) {
    legs(0.0, sample);
    sample.linear_velocity.x() += 0.05;
  };
  EXPECT_EQ(observe(rig).standing, 0) << "slow walking";
}

TEST(ZeroVelocity, OneFootWhoseLoadIsLostDoesNotHideThatTheRobotStands) {
  Rig rig;
  rig.legs = [](double, LegOdometrySample& legs) { legs.contact[2] = false; };
  EXPECT_GT(observe(rig).standing, 400);
  rig.legs = [](double, LegOdometrySample& legs) { legs.contact.fill(false); };
  EXPECT_GT(observe(rig).standing, 400) << "no load at all";
  rig.legs = [](double, LegOdometrySample& legs) { legs.contact[0] = legs.contact[3] = false; };
  EXPECT_EQ(observe(rig).standing, 0) << "in the middle of a trot";
}

TEST(ZeroVelocity, LiftedFeetAreNotStanding) {
  Rig rig;
  rig.legs = [](double t, LegOdometrySample& legs) {
    legs.contact[0] = std::fmod(t, 0.5) > 0.2;
    legs.joint_velocity[1] += legs.contact[0] ? 0.05 : 1.5;
  };
  EXPECT_EQ(observe(rig).standing, 0);
}

TEST(ZeroVelocity, APushIsNotStanding) {
  Rig rig;
  rig.imu = [](double t, ImuSample& sample) {
    if (t > 1.5) sample.specific_force.y() += 1.0 * std::sin(8.0 * t);
  };
  const Outcome pushed = observe(rig);
  EXPECT_GT(pushed.standing, 100);
  EXPECT_LT(pushed.standing, 260);
}

TEST(ZeroVelocity, TurningAndSlidingAreNotStanding) {
  Rig turning;
  turning.imu = [](double, ImuSample& sample) { sample.angular_velocity.z() += 0.1; };
  EXPECT_EQ(observe(turning).standing, 0);
  Rig sliding;
  sliding.legs = [](double, LegOdometrySample& legs) { legs.linear_velocity.x() += 0.05; };
  EXPECT_EQ(observe(sliding).standing, 0);
}

TEST(ZeroVelocity, NotDetectedWithoutImuSamples) {
  ZeroVelocityDetector detector;
  LegOdometrySample legs;
  for (Time t = 0; t < kSecond; t += kLegPeriod) {
    legs.stamp = t;
    EXPECT_FALSE(detector.update(legs, {}, Eigen::Vector3d::Zero()));
  }
}

TEST(ZeroVelocity, JacobiansMatchFiniteDifferences) {
  NominalState state;
  state.rotation = so3_exp({0.2, -0.3, 1.0});
  state.velocity = {0.4, -0.2, 0.1};
  state.gyro_bias = {0.01, 0.02, 0.03};
  const Eigen::Vector3d rate(0.02, 0.0, -0.01);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < ErrorState::kSize; ++i) {
    const ErrorVector delta = kStep * ErrorVector::Unit(i);
    const NominalState up = boxplus(state, delta);
    const NominalState down = boxplus(state, -delta);
    const Eigen::Vector3d velocity =
        (zero_velocity_model(up, 1.0).residual - zero_velocity_model(down, 1.0).residual) /
        (2.0 * kStep);
    const Eigen::Vector3d bias =
        (zero_rate_model(up, rate, 1.0).residual - zero_rate_model(down, rate, 1.0).residual) /
        (2.0 * kStep);
    EXPECT_LT((velocity - zero_velocity_model(state, 1.0).jacobian.col(i)).norm(), 1e-8) << i;
    EXPECT_LT((bias - zero_rate_model(state, rate, 1.0).jacobian.col(i)).norm(), 1e-8) << i;
  }
}

}  // namespace
}  // namespace aims
