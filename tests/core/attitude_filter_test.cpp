// SPDX-License-Identifier: BSD-3-Clause
#include "core/attitude_filter.hpp"

#include <gtest/gtest.h>

#include "core/lie.hpp"
#include "core/random.hpp"

namespace aims {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr Duration kStep = 20 * kMillisecond;

ImuSample at_rest(Time stamp, const Quaterniond& attitude) {
  return {stamp, Vector3d::Zero(), attitude.conjugate() * Vector3d(0.0, 0.0, 9.81)};
}

double tilt_between(const Quaterniond& a, const Quaterniond& b) {
  const Vector3d up_a = a.conjugate() * Vector3d::UnitZ();
  const Vector3d up_b = b.conjugate() * Vector3d::UnitZ();
  return std::atan2(up_a.cross(up_b).norm(), up_a.dot(up_b));
}

TEST(AttitudeFilter, StartsLevelWithGravityAndAtHeadingZero) {
  const Quaterniond attitude = yaw_rotation(1.0) * so3_exp({0.2, -0.1, 0.0});
  AttitudeFilter filter;
  const Quaterniond found = filter.update(at_rest(0, attitude));
  EXPECT_LT(tilt_between(found, attitude), 1e-9);
  EXPECT_NEAR(yaw_of(found), 0.0, 1e-9);
}

TEST(AttitudeFilter, FollowsATurnByTheGyroAlone) {
  AttitudeFilter filter;
  Quaterniond attitude = so3_exp({0.1, 0.05, 0.0});
  const double heading = yaw_of(attitude);
  const Vector3d rate(0.0, 0.0, 0.4);
  Quaterniond found = filter.update(at_rest(0, attitude));
  for (Time t = kStep; t <= 2 * kSecond; t += kStep) {
    attitude = yaw_rotation(0.4 * to_seconds(t)) * so3_exp({0.1, 0.05, 0.0});
    ImuSample sample = at_rest(t, attitude);
    sample.angular_velocity = attitude.conjugate() * rate;
    found = filter.update(sample);
  }
  EXPECT_NEAR(wrap_angle(yaw_of(found) - (yaw_of(attitude) - heading)), 0.0, 1e-3);
  EXPECT_LT(tilt_between(found, attitude), 1e-3);
}

TEST(AttitudeFilter, LevelsAGyroBiasButLetsTheHeadingDrift) {
  AttitudeFilter filter;
  RandomStream noise(5, "noise");
  Quaterniond found;
  for (Time t = 0; t <= 60 * kSecond; t += kStep) {
    ImuSample sample = at_rest(t, Quaterniond::Identity());
    sample.angular_velocity = Vector3d(2e-3, -1e-3, 3e-3) + 1e-3 * noise.normal3();
    found = filter.update(sample);
  }
  EXPECT_LT(tilt_between(found, Quaterniond::Identity()), 0.02) << "bias / levelling rate";
  EXPECT_NEAR(yaw_of(found), 0.18, 0.02);
}

}  // namespace
}  // namespace aims
