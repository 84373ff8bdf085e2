// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/leg_stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/recordings/legs/trot.hpp"

namespace aims {
namespace {

LegStreamConfig kinematic() {
  LegStreamConfig config;
  config.source = LegSource::kKinematics;
  config.half_period = 2 * kMillisecond;
  config.geometry = {0.188, 0.047, 0.08, 0.213, 0.213, 0.022};
  return config;
}

ImuSample at_rest(Time stamp) {
  ImuSample sample;
  sample.stamp = stamp;
  sample.specific_force.z() = 9.81;
  return sample;
}

/// All legs swing back at the hip: a base that moves forward.
JointReading striding(Time stamp, double angle = 0.8) {
  JointReading reading;
  reading.stamp = stamp;
  reading.velocity.emplace();
  for (std::size_t leg = 0; leg < 4; ++leg) {
    reading.position[3 * leg + 1] = angle;
    reading.position[3 * leg + 2] = -1.6;
    (*reading.velocity)[3 * leg + 1] = 1.0;
  }
  return reading;
}

TEST(LegStream, CombinesContactsOfTheSameInstantElseTheLastOnes) {
  LegStream legs(kinematic());
  EventCounts counts;
  legs.add_imu(at_rest(0));
  EXPECT_FALSE(legs.add_joints(striding(10 * kMillisecond), counts));
  const auto same = legs.add_contacts({11 * kMillisecond, {true, true, true, true}}, counts);
  ASSERT_TRUE(same);
  EXPECT_EQ(same->stamp, 10 * kMillisecond);
  EXPECT_GT(same->linear_velocity.x(), 0.2);
  EXPECT_FALSE(legs.add_joints(striding(20 * kMillisecond), counts));
  const auto with_last = legs.add_joints(striding(30 * kMillisecond), counts);
  ASSERT_TRUE(with_last);
  EXPECT_EQ(with_last->stamp, 20 * kMillisecond);
  EXPECT_TRUE(counts.empty());
}

TEST(LegStream, ATwistOfZeroIsThatOfThePoses) {
  // A circle of 2 m at 0.5 m/s.
  const auto odometry = [](double time) {
    LegOdometrySample sample;
    sample.stamp = from_seconds(time);
    const double yaw = 0.25 * time;
    sample.T_odom_base = {yaw_rotation(yaw), {2.0 * std::sin(yaw), 2.0 - 2.0 * std::cos(yaw), 0.0}};
    return sample;
  };
  LegStreamConfig config;
  config.source = LegSource::kOdometry;
  LegStream legs(config);
  EventCounts counts;
  EXPECT_TRUE(legs.add_odometry(odometry(0.0), counts).linear_velocity.isZero(0.0));
  const LegOdometrySample moving = legs.add_odometry(odometry(0.02), counts);
  EXPECT_NEAR((moving.linear_velocity - Eigen::Vector3d(0.5, 0.0, 0.0)).norm(), 0.0, 1e-5);
  EXPECT_NEAR((moving.angular_velocity - Eigen::Vector3d(0.0, 0.0, 0.25)).norm(), 0.0, 1e-9);
  EXPECT_EQ(counts.at("legs_twist_by_pose_differences"), 1);
  LegOdometrySample standing = odometry(0.02);
  standing.stamp = from_seconds(0.04);
  EXPECT_TRUE(legs.add_odometry(standing, counts).linear_velocity.isZero(0.0));
  EXPECT_EQ(counts.at("legs_twist_by_pose_differences"), 1);
}

TEST(LegStream, KeepsTheLastVelocityWithoutContacts) {
  LegStream legs(kinematic());
  EventCounts counts;
  legs.add_imu(at_rest(0));
  legs.add_contacts({10 * kMillisecond, {true, false, false, true}}, counts);
  const auto standing = legs.add_joints(striding(10 * kMillisecond), counts);
  legs.add_contacts({20 * kMillisecond, {}}, counts);
  const auto flying = legs.add_joints(striding(20 * kMillisecond), counts);
  ASSERT_TRUE(standing && flying);
  EXPECT_EQ(flying->linear_velocity, standing->linear_velocity);
  EXPECT_NEAR(flying->T_odom_base.translation.x(), 0.01 * standing->linear_velocity.x(), 1e-6);
  EXPECT_EQ(counts, (EventCounts{{"legs_no_contact", 1}}));
}

TEST(LegStream, ARobotThatIsCarriedHasNoLegOdometry) {
  LegStream legs(kinematic());
  EventCounts counts;
  legs.add_imu(at_rest(0));
  const auto at = [&](Time stamp, std::array<bool, kLegCount> contact) {
    legs.add_contacts({stamp, contact}, counts);
    return legs.add_joints(striding(stamp), counts);
  };
  const auto standing = at(10 * kMillisecond, {true, false, false, true});
  ASSERT_TRUE(standing);
  for (int i = 1; i <= 50; ++i) EXPECT_TRUE(at(standing->stamp + i * 10 * kMillisecond, {})) << i;
  for (int i = 51; i < 500; ++i) EXPECT_FALSE(at(standing->stamp + i * 10 * kMillisecond, {})) << i;
  EXPECT_EQ(counts["legs_in_the_air"], 449);
  const auto down = at(standing->stamp + 5 * kSecond, {true, true, true, true});
  ASSERT_TRUE(down);
  EXPECT_LT(down->T_odom_base.translation.x(), 0.6 * standing->linear_velocity.x());
}

TEST(LegStream, LegsWithoutAnyContactStay) {
  LegStream legs(kinematic());  // the sensors of the feet are dead: others may do without them
  EventCounts counts;
  legs.add_imu(at_rest(0));
  for (Time stamp = kMillisecond; stamp < 2 * kSecond; stamp += 10 * kMillisecond) {
    legs.add_contacts({stamp, {}}, counts);
    EXPECT_TRUE(legs.add_joints(striding(stamp), counts));
  }
}

TEST(LegStream, OldContactsAreNotUsed) {
  LegStream legs(kinematic());
  EventCounts counts;
  legs.add_imu(at_rest(0));
  legs.add_contacts({0, {true, true, true, true}}, counts);
  legs.add_joints(striding(kSecond), counts);
  EXPECT_FALSE(legs.add_joints(striding(kSecond + 10 * kMillisecond), counts));
  EXPECT_EQ(counts, (EventCounts{{"legs_without_contacts", 1}}));
}

TEST(LegStream, MissingRatesAreDifferencesOfAngles) {
  LegStream legs(kinematic());
  EventCounts counts;
  legs.add_imu(at_rest(0));
  const ContactReading standing{0, {true, true, true, true}};
  JointReading first = striding(0, 0.8);
  JointReading second = striding(10 * kMillisecond, 0.81);
  first.velocity.reset();
  second.velocity.reset();
  legs.add_contacts(standing, counts);
  EXPECT_FALSE(legs.add_joints(first, counts));
  ContactReading later = standing;
  later.stamp = 10 * kMillisecond;
  EXPECT_FALSE(legs.add_joints(second, counts));
  const auto sample = legs.add_contacts(later, counts);
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->joint_velocity[1], 1.0, 1e-9);
}

TEST(LegStream, NoRateIsADifferenceAcrossTouchdown) {
  LegStream legs(kinematic());
  EventCounts counts;
  legs.add_imu(at_rest(0));
  std::vector<LegOdometrySample> samples;
  // The legs swing forwards, touch down at the fourth sample and then move back at 1 rad/s.
  constexpr std::array<double, 6> kAngles = {0.6, 0.7, 0.8, 0.9, 0.91, 0.92};
  for (std::size_t k = 0; k < kAngles.size(); ++k) {
    const Time stamp = static_cast<Time>(k) * 10 * kMillisecond;
    const bool stands = k >= 3;
    JointReading reading = striding(stamp, kAngles[k]);
    reading.velocity.reset();
    legs.add_contacts({stamp, {stands, stands, stands, stands}}, counts);
    if (const auto sample = legs.add_joints(reading, counts)) samples.push_back(*sample);
  }
  ASSERT_EQ(samples.size(), 5U);
  EXPECT_FALSE(samples[2].contact[0]) << "the rate is still that of the swing";
  EXPECT_TRUE(samples[3].contact[0]);
  const double speed = samples[4].linear_velocity.norm();
  EXPECT_LT(samples[2].linear_velocity.norm(), 1e-12);
  EXPECT_NEAR(samples[3].linear_velocity.norm(), speed, 0.02 * speed);
}

/// Warnings of a trot of 30 s, of which angles are recorded, without rates or with rates of zero;
/// `off`: on the angles of all legs, or of one [rad].
std::string warnings_without_rates(double rate_hz, const Eigen::Vector3d& off,
                                   std::optional<int> leg = std::nullopt, bool zeros = false) {
  const test::Trot trot;
  LegStream legs(kinematic());
  EventCounts counts;
  const int samples = static_cast<int>(30.0 * rate_hz);
  for (int i = 0; i < samples; ++i) {
    const double time = i / rate_hz;
    const Time stamp = from_seconds(time);
    legs.add_imu(at_rest(stamp));
    legs.add_contacts({stamp, trot.contact(time)}, counts);
    JointReading joints;
    joints.stamp = stamp;
    const JointVector angles = trot.angles(time);
    for (int k = 0; k < kJointCount; ++k) {
      const bool is_off = !leg || k / 3 == *leg;
      joints.position[static_cast<std::size_t>(k)] = angles[k] + (is_off ? off[k % 3] : 0.0);
    }
    if (zeros) joints.velocity.emplace();
    legs.add_joints(std::move(joints), counts);
  }
  std::string text;
  for (const ReadingWarning& each : legs.warnings()) text += each.text + "\n";
  return text;
}

TEST(LegStream, WrongZerosOfJointsWithoutRatesAreNamed) {
  const auto is_named = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  for (const double rate : {50.0, 100.0, 400.0}) {
    EXPECT_EQ(warnings_without_rates(rate, Eigen::Vector3d::Zero()), "") << rate;
    EXPECT_EQ(warnings_without_rates(rate, {0.03, -0.05, 0.05}), "") << rate;
    for (const double sign : {-1.0, 1.0}) {
      const Eigen::Vector3d hip(0.0, 0.3 * sign, 0.0);
      is_named(warnings_without_rates(rate, hip), "the zero of the hip is off");
      is_named(warnings_without_rates(rate, hip, 2), "base, RL ");
      is_named(warnings_without_rates(rate, hip, 2, true), "base, RL ");
      is_named(warnings_without_rates(rate, {0.0, 0.0, 0.6 * sign}), "the zero of the hip is off");
    }
  }
}

TEST(LegStream, UpIsPropagatedByTheGyroAndCorrectedByTheSpecificForce) {
  UpDirection up;
  for (int k = 0; k <= 2000; ++k) {
    ImuSample sample = at_rest(k * 10 * kMillisecond);
    sample.specific_force = {9.81 * std::sin(0.3), 0.0, 9.81 * std::cos(0.3)};
    up.add(sample);
  }
  EXPECT_LT((*up.in_body() - Eigen::Vector3d(std::sin(0.3), 0.0, std::cos(0.3))).norm(), 1e-6);
  // A quick turn about y is followed at once, long before the force would have drawn it there.
  ImuSample turning = at_rest(20'010 * kMillisecond);
  turning.specific_force = {9.81 * std::sin(0.3), 0.0, 9.81 * std::cos(0.3)};
  turning.angular_velocity.y() = 20.0;
  up.add(turning);
  EXPECT_NEAR(std::atan2(up.in_body()->x(), up.in_body()->z()), 0.3 - 0.2, 2e-3);
}

TEST(LegStream, ImplausibleTwistsAreNotIntegrated) {
  LegStreamConfig config;
  config.source = LegSource::kTwist;
  LegStream legs(config);
  LegOdometrySample sample;
  sample.linear_velocity.x() = 1.0;
  legs.add_twist(sample);
  sample.stamp = 10 * kMillisecond;
  sample.angular_velocity.z() = 1e300;
  legs.add_twist(sample);
  sample.stamp = 20 * kMillisecond;
  sample.angular_velocity.z() = std::nan("");
  legs.add_twist(sample);
  sample.stamp = 30 * kMillisecond;
  sample.angular_velocity.z() = 0.0;
  EXPECT_NEAR(legs.add_twist(sample).T_odom_base.translation.x(), 0.01, 1e-12);
}

/// What is said of a twist of `factor` times the velocity and the turn rate of the pose.
std::string contradiction_of(double of_velocity, double of_turning) {
  LegStream legs({});
  EventCounts counts;
  for (int i = 0; i < 1000; ++i) {
    const double yaw = 0.003 * i;
    LegOdometrySample sample;
    sample.stamp = i * 10 * kMillisecond;
    sample.T_odom_base = {yaw_rotation(yaw), {2.0 * std::sin(yaw), 2.0 - 2.0 * std::cos(yaw), 0.0}};
    sample.linear_velocity = {of_velocity * 0.6, 0.0, 0.0};
    sample.angular_velocity = {0.0, 0.0, of_turning * 0.3};
    legs.add_odometry(sample, counts);
  }
  const auto found = legs.warnings();
  return found.empty() ? "" : found.front().text;
}

TEST(LegStream, ATwistThatContradictsThePoseIsNamed) {
  EXPECT_EQ(contradiction_of(1.0, 1.0), "");
  EXPECT_EQ(contradiction_of(1.2, 1.0), "") << "slip";
  const std::string backwards = contradiction_of(-1.0, 1.0);
  EXPECT_NE(backwards.find("its mean velocity in axes of the base is (0.59, 0.09, 0.00) m/s by its "
                           "pose and (-0.59, -0.09, 0.00) by its twist"),
            std::string::npos)
      << backwards;
  EXPECT_NE(contradiction_of(1.0, 57.3).find("it turns by "), std::string::npos);
}

/// Seconds counted as of a twist in the wrong axes, on a walk along a curve.
int wrong_seconds(bool in_odometry_axes) {
  LegStreamConfig config;
  config.source = LegSource::kOdometry;
  LegStream legs(config);
  EventCounts counts;
  LegOdometrySample sample;
  for (int k = 0; k < 1000; ++k) {
    const double heading = 0.003 * k;
    const Eigen::Vector3d velocity = yaw_rotation(heading) * Eigen::Vector3d(0.6, 0.0, 0.0);
    sample.stamp = k * 10 * kMillisecond;
    sample.T_odom_base.rotation = yaw_rotation(heading);
    sample.T_odom_base.translation += 0.01 * velocity;
    sample.linear_velocity = in_odometry_axes ? velocity : Eigen::Vector3d(0.6, 0.0, 0.0);
    legs.add_odometry(sample, counts);
  }
  return counts["legs_twist_in_odometry_axes_seconds"];
}

TEST(LegStream, ATwistInOdometryAxesIsCountedOnceTheRobotHasTurned) {
  EXPECT_EQ(wrong_seconds(false), 0);
  EXPECT_GE(wrong_seconds(true), 6);  // from half a radian of heading on
}

/// Speeds of a trot of which each half of the stride has its own feet, whose contacts or joints
/// arrive `late`.
double mean_speed(Duration contacts_late, Duration joints_late) {
  LegStreamConfig config = kinematic();
  config.contact_wait = 2 * contacts_late;
  LegStream legs(config);
  EventCounts counts;
  legs.add_imu(at_rest(0));
  double sum = 0.0;
  int samples = 0;
  const auto take = [&](std::optional<LegOdometrySample> sample) {
    for (; sample; sample = legs.next(counts)) {
      sum += sample->linear_velocity.x();
      ++samples;
    }
  };
  for (int k = 0; k < 1000; ++k) {
    const Time now = k * 5 * kMillisecond;
    const auto even = [](Time stamp) { return stamp / (200 * kMillisecond) % 2 == 0; };
    if (const Time stamp = now - contacts_late; stamp >= 0) {
      take(legs.add_contacts({stamp, {even(stamp), !even(stamp), !even(stamp), even(stamp)}},
                             counts));
    }
    const Time stamp = now - joints_late;
    if (stamp < 0) continue;
    JointReading reading = striding(stamp);
    for (std::size_t leg = 0; leg < 4; ++leg) {
      const bool stands = (leg % 3 == 0) == even(stamp);
      (*reading.velocity)[3 * leg + 1] = stands ? 1.0 : -1.0;
    }
    take(legs.add_joints(reading, counts));
  }
  EXPECT_GT(samples, 950);
  return sum / samples;
}

TEST(LegStream, JointsAndContactsArePairedByTheirStamps) {
  const double right = mean_speed(0, 0);
  EXPECT_GT(right, 0.2);
  EXPECT_NEAR(mean_speed(60 * kMillisecond, 0), right, 0.02 * right);
  EXPECT_NEAR(mean_speed(0, 60 * kMillisecond), right, 0.02 * right);
}

TEST(LegStream, APoseThatDoesNotMoveIsThatOfTheTwist) {
  for (const bool filled : {false, true}) {
    LegStreamConfig config;
    config.source = LegSource::kOdometry;
    LegStream legs(config);
    EventCounts counts;
    LegOdometrySample last;
    for (int k = 0; k <= 400; ++k) {
      LegOdometrySample sample;
      sample.stamp = k * 10 * kMillisecond;
      sample.linear_velocity.x() = k < 100 ? 0.0 : 0.5;
      if (filled) sample.T_odom_base.translation.x() = std::max(0, k - 100) * 0.005;
      last = legs.add_odometry(sample, counts);
    }
    EXPECT_NEAR(last.T_odom_base.translation.x(), 1.5, 0.01);
    EXPECT_EQ(counts.contains("legs_pose_by_twist"), !filled);
  }
}

/// The hip's rate that the last sample has where angles advance by 1 rad/s.
double last_rate(const std::function<void(int, JointReading&)>& change, EventCounts& counts) {
  LegStream legs(kinematic());
  legs.add_imu(at_rest(0));
  double rate = 0.0;
  for (int k = 0; k < 40; ++k) {
    JointReading reading = striding(k * 5 * kMillisecond, 0.6 + 0.005 * k);
    change(k, reading);
    legs.add_contacts({reading.stamp, {true, true, true, true}}, counts);
    auto sample = legs.add_joints(reading, counts);
    for (; sample; sample = legs.next(counts)) rate = sample->joint_velocity[1];
  }
  return rate;
}

TEST(LegStream, RatesThatADriverLeavesEmptyAreDifferences) {
  for (const double empty : {0.0, std::nan("")}) {
    EventCounts counts;
    const double rate =
        last_rate([empty](int, JointReading& each) { each.velocity->fill(empty); }, counts);
    EXPECT_NEAR(rate, 1.0, 1e-9);
    EXPECT_GT(counts.at("joint_rates_empty"), 30);
  }
}

TEST(LegStream, NoRateIsADifferenceOverARepeatedStamp) {
  EventCounts counts;
  const double rate = last_rate(
      [](int k, JointReading& each) {
        each.velocity.reset();
        each.stamp = k / 2 * 10 * kMillisecond;
      },
      counts);
  EXPECT_NEAR(rate, 1.0, 1e-9);
  EXPECT_EQ(counts.at("joints_stamp_repeated"), 20);
}

}  // namespace
}  // namespace aims
