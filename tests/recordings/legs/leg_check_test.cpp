// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/leg_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <random>

namespace aims {
namespace {

constexpr LegGeometry kLegs = {0.188, 0.047, 0.08, 0.213, 0.213, 0.022};

/// Of walks on FL and RR alone.
constexpr std::array<bool, kLegCount> kDiagonalAlone = {false, true, true, false};

/// What a robot of which something is wrong records.
struct Fault {
  std::function<void(StandingFoot&)> of_foot = [](StandingFoot&) {};
  std::function<void(ImuSample&)> of_imu = [](ImuSample&) {};
  std::optional<int> idle = std::nullopt;                      ///< a foot that never stands
  std::optional<int> frozen = std::nullopt;                    ///< a leg whose angles stand still
  std::function<bool(int)> still = [](int) { return false; };  ///< whether a joint's angle does
  bool unknown = false;                                        ///< its angles are no numbers
  bool differenced = false;
  int rate = 100;  ///< [Hz]
  std::array<bool, kLegCount> without_contacts{};
};

/// Warnings of a robot that walks to and fro and turns, for 30 s, on two feet at a time, with noise
/// of 0.2 m/s on their velocities.
std::vector<ReadingWarning> warnings_of(const Fault& fault) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.2);
  LegCheck check(kLegs, fault.without_contacts);
  for (int i = 0; i < 30 * fault.rate; ++i) {
    const double time = i / static_cast<double>(fault.rate);
    const Eigen::Vector3d velocity(0.5 * std::sin(time), 0.3 * std::sin(1.3 * time), 0.0);
    const Eigen::Vector3d turning(0.0, 0.0, 0.6 * std::sin(0.7 * time));
    ImuSample imu;
    imu.stamp = from_seconds(time);
    imu.angular_velocity = turning;
    imu.specific_force = Eigen::Vector3d(0.5 * std::cos(time), 0.39 * std::cos(1.3 * time), 9.81) +
                         turning.cross(velocity);
    fault.of_imu(imu);
    check.add_imu(imu, Eigen::Vector3d::Zero());
    std::vector<StandingFoot> feet;
    Eigen::Vector3d stated = Eigen::Vector3d::Zero();
    const bool first = std::fmod(time, 0.5) < 0.25;
    for (const int leg : first ? std::array{0, 3} : std::array{1, 2}) {
      if (leg == fault.idle) continue;
      const Eigen::Vector3d place = foot_in_base(leg, {0.0, 0.8, -1.6}, kLegs);
      const Eigen::Vector3d slip(noise(random), noise(random), noise(random));
      StandingFoot foot = {leg, place, slip - velocity - turning.cross(place)};
      fault.of_foot(foot);
      feet.push_back(foot);
      stated -= foot.velocity + imu.angular_velocity.cross(foot.position);
    }
    stated /= static_cast<double>(feet.size());
    std::array<double, kJointCount> angles{};
    for (int k = 0; k < kJointCount; ++k)
      angles[static_cast<std::size_t>(k)] = k / 3 == fault.frozen || fault.still(k) ? 0.8 : time;
    std::array<bool, kLegCount> unknown{};
    if (fault.frozen) unknown[static_cast<std::size_t>(*fault.frozen)] = fault.unknown;
    check.add_joints(angles, unknown);
    check.add_feet(feet, stated, fault.differenced);
  }
  return check.warnings();
}

std::string text_of(const std::vector<ReadingWarning>& warnings) {
  std::string text;
  for (const ReadingWarning& each : warnings) text += each.text + "\n";
  return text;
}

void expect_named(const Fault& fault, const std::string& cause) {
  const std::string text = text_of(warnings_of(fault));
  EXPECT_NE(text.find(cause), std::string::npos) << cause << "\n" << text;
}

TEST(LegCheck, AWalkingRobotIsNotWarnedOf) {
  EXPECT_EQ(text_of(warnings_of({})), "");
  const auto late_load = [](StandingFoot& foot) { foot.velocity *= 0.75; };
  EXPECT_EQ(text_of(warnings_of({.of_foot = late_load})), "") << "as of a real robot";
}

/// The foot as joints with other zeros [rad] state it; of all legs, or of one.
Fault zeros(const Eigen::Vector3d& off, std::optional<int> leg = std::nullopt) {
  return {.of_foot = [off, leg](StandingFoot& foot) {
    if (leg && foot.leg != *leg) return;
    const Eigen::Vector3d q(0.0, 0.8, -1.6);
    const Eigen::Vector3d rates =
        foot_jacobian(foot.leg, q, kLegs).partialPivLu().solve(foot.velocity);
    foot.position = foot_in_base(foot.leg, q + off, kLegs);
    foot.velocity = foot_jacobian(foot.leg, q + off, kLegs) * rates;
  }};
}

TEST(LegCheck, ZerosOfJointsThatAreOffByAThirdOfARadianAreNamed) {
  const std::string of_hip = "the zero of the hip is off", of_abduction = "of the abductions";
  for (const double sign : {-1.0, 1.0}) {
    expect_named(zeros({0.0, sign * 0.3, 0.0}), of_hip);
    expect_named(zeros({0.0, sign * 0.35, 0.0}, 2), of_hip);
    expect_named(zeros({0.0, sign * 0.35, 0.0}, 2), "base, RL ");
    expect_named(zeros({0.0, 0.0, sign * 0.6}), of_hip);
    expect_named(zeros({sign * 0.35, 0.0, 0.0}), of_abduction);
  }
  EXPECT_EQ(text_of(warnings_of(zeros({0.03, -0.05, 0.05}))), "");
}

TEST(LegCheck, AFootThatNeverStandsAndALegWhoseAnglesStandStillAreNamed) {
  expect_named({.idle = 2}, "no contact of RL while the robot walks");
  EXPECT_EQ(text_of(warnings_of({.idle = 2, .without_contacts = {false, false, true, false}})), "")
      << "said before";
  expect_named({.frozen = 1}, "the joint angles of FR do not change while the robot walks");
  EXPECT_EQ(text_of(warnings_of({.frozen = 1, .unknown = true})), "");
}

TEST(LegCheck, AJointWhoseAngleStandsStillIsNamed) {
  expect_named({.still = [](int joint) { return joint == 5; }}, "angles of FR (knee) do not");
  expect_named({.still = [](int joint) { return joint == 6 || joint == 7; }},
               "angles of RL (abduction, hip) do not");
  expect_named({.frozen = 1, .still = [](int joint) { return joint % 3 == 0; }},
               "angles of FR do not");
  EXPECT_EQ(text_of(warnings_of({.still = [](int joint) { return joint % 3 == 0; }})), "")
      << "a robot without abductions";
}

TEST(LegCheck, AFootThatNeverStandsHidesNoOtherFault) {
  Fault fault = {.of_imu = [](ImuSample& imu) { imu.angular_velocity *= -1.0; }, .idle = 2};
  const std::string text = text_of(warnings_of(fault));
  fault.without_contacts[2] = true;
  EXPECT_NE(text.find("no contact of RL while the robot walks"), std::string::npos) << text;
  EXPECT_NE(text.find(text_of(warnings_of(fault))), std::string::npos) << text;
  EXPECT_NE(text.find("z of the gyro or all joints have the wrong sign"), std::string::npos)
      << text;
  EXPECT_EQ(warnings_of({.idle = 2}).size(), 1U) << text_of(warnings_of({.idle = 2}));
}

TEST(LegCheck, DifferencesToTheLastAnglesTellNoSlope) {
  Fault fault = zeros({0.0, 0.35, 0.0}, 2);
  fault.differenced = true;
  EXPECT_EQ(text_of(warnings_of(fault)), "");
}

TEST(LegCheck, ExchangedLegsAreNamed) {
  const auto left_right = [](StandingFoot& foot) { foot.position.y() *= -1.0; };
  const auto front_rear = [](StandingFoot& foot) { foot.position.x() *= -1.0; };
  expect_named({.of_foot = left_right}, "left and the right are exchanged");
  expect_named({.of_foot = front_rear}, "front and rear legs are exchanged");
}

TEST(LegCheck, AGyroThatTheFeetContradictIsNamedWithItsCause) {
  const auto scaled = [](double by) {
    return Fault{.of_imu = [by](ImuSample& imu) { imu.angular_velocity *= by; }};
  };
  expect_named(scaled(57.3), "recording.gyro_unit=deg/s");
  expect_named(scaled(57.3), "though recording.joint_unit is deg");
  expect_named(scaled(-1.0), "z of the gyro or all joints have the wrong sign");
  expect_named(scaled(0.4), "the scale of the gyro");
}

TEST(LegCheck, AnAccelerometerThatTheLegsContradictIsNamed) {
  const auto mirrored = [](StandingFoot& foot) { foot.velocity.x() *= -1.0; };
  expect_named({.of_foot = mirrored}, "x of the accelerometer, or the joints");
  const auto small = [](StandingFoot& foot) { foot.velocity *= 0.4; };
  expect_named({.of_foot = small, .rate = 200}, "the lengths (leg_geometry), the zero or the unit");
}

TEST(LegCheck, SingleSamplesOfASlowAccelerometerAreNoScale) {
  const auto small = [](StandingFoot& foot) { foot.velocity *= 0.4; };
  for (const int rate : {50, 100}) {
    const std::string text = text_of(warnings_of({.of_foot = small, .rate = rate}));
    EXPECT_EQ(text.find("accelerometer"), std::string::npos) << text;
  }
}

/// Of a robot that walks straight ahead and rolls by 1.5 degrees to and fro; `sign`: of y of its
/// accelerometer.
std::string warnings_of_rolling_walk(double sign) {
  LegCheck check(kLegs, kDiagonalAlone);
  for (int i = 0; i < 3000; ++i) {
    const double phase = 0.01 * i;  // [s]
    const double roll = 0.026 * std::sin(2.0 * phase), rate = 0.052 * std::cos(2.0 * phase);
    ImuSample imu;
    imu.stamp = i * 10 * kMillisecond;
    imu.angular_velocity = {rate, 0.0, 0.0};
    imu.specific_force = {0.0, sign * 9.81 * std::sin(roll), 9.81 * std::cos(roll)};
    check.add_imu(imu, Eigen::Vector3d::Zero());
    const Eigen::Vector3d velocity(0.5, 0.0, 0.0);
    std::vector<StandingFoot> feet;
    for (const int leg : {0, 3}) {
      const Eigen::Vector3d place = foot_in_base(leg, {0.0, 0.8, -1.6}, kLegs);
      feet.push_back({leg, place, -velocity - imu.angular_velocity.cross(place)});
    }
    check.add_feet(feet, velocity);
  }
  return text_of(check.warnings());
}

TEST(LegCheck, AnAxisOfTheAccelerometerWithTheWrongSignIsNamedInAStraightWalk) {
  EXPECT_EQ(warnings_of_rolling_walk(1.0), "");
  const std::string named = warnings_of_rolling_walk(-1.0);
  EXPECT_NE(named.find("y of the accelerometer, or of the velocity"), std::string::npos) << named;
}

/// Of a robot that stands, walks straight ahead for some 11 s and stands, by a foot in front
/// and one behind; `sign`: of what the feet do.
std::vector<ReadingWarning> warnings_of_straight_walk(double sign) {
  LegCheck check(kLegs, kDiagonalAlone);
  for (int i = 0; i < 1500; ++i) {
    const double phase = 0.01 * i;  // [s]
    const double speed = 0.5 * std::clamp(std::min(phase - 2.0, 14.0 - phase), 0.0, 1.0);
    const double force = phase > 2.0 && phase < 3.0     ? 0.5
                         : phase > 13.0 && phase < 14.0 ? -0.5
                                                        : 0.0;
    ImuSample imu;
    imu.stamp = i * 10 * kMillisecond;
    imu.specific_force = Eigen::Vector3d(force, 0.0, 9.81);
    check.add_imu(imu, Eigen::Vector3d::Zero());
    const Eigen::Vector3d velocity(sign * speed, 0.0, 0.0);
    std::vector<StandingFoot> feet;
    for (const int leg : {0, 3}) {
      feet.push_back({leg, foot_in_base(leg, {0.0, 0.8, -1.6}, kLegs), -velocity});
    }
    check.add_feet(feet, velocity);
  }
  return check.warnings();
}

TEST(LegCheck, LegsThatWalkBackwardsAreNamedByStartsAndStops) {
  EXPECT_EQ(text_of(warnings_of_straight_walk(1.0)), "");
  EXPECT_NE(text_of(warnings_of_straight_walk(-1.0)).find("in 2 of 2 starts and stops"),
            std::string::npos)
      << text_of(warnings_of_straight_walk(-1.0));
}

TEST(LegCheck, FeetOnWhichNoRobotWalksAreNamed) {
  for (const Eigen::Vector3d& q :
       {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.0, 0.8, 1.6)}) {
    const auto other_zero = [&q](StandingFoot& foot) {
      foot.position = foot_in_base(foot.leg, q, kLegs);
    };
    const auto found = warnings_of({.of_foot = other_zero});
    ASSERT_FALSE(found.empty()) << q.transpose();
    EXPECT_NE(found[0].text.find("the zero, a sign or the unit"), std::string::npos);
    EXPECT_EQ(found[0].sensor, WarnedSensor::kLegs);
  }
}

TEST(LegCheck, FeetWithoutLengthsOfLegsAreNotJudgedByTheirPlace) {
  LegCheck check((LegGeometry()));
  for (int i = 0; i < 1000; ++i) {
    ImuSample imu;
    imu.stamp = i * 10 * kMillisecond;
    imu.specific_force.z() = 9.81;
    check.add_imu(imu, Eigen::Vector3d::Zero());
    check.add_feet({{0, {1.0, 0.0, 2.0}, {-0.5, 0.0, 0.0}}}, {0.5, 0.0, 0.0});
  }
  EXPECT_TRUE(check.warnings().empty());
}

}  // namespace
}  // namespace aims
