// SPDX-License-Identifier: BSD-3-Clause
#include "live/clock_watch.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

constexpr Duration kImuPeriod = 5 * kMillisecond;
constexpr int kImuPerScan = 20;

/// A robot whose sensors stamp by a clock of their own.
struct Robot {
  ClockWatch watch;
  Time now = 1000 * kSecond;
  Duration imu_clock = -700 * kSecond;  ///< over this computer's
  Duration lidar_clock = -700 * kSecond;
  bool lidar = true;

  /// Everything of the next seconds; a message needs `delay` for its way.
  void run(double seconds, Duration delay = 3 * kMillisecond) {
    const Time end = now + from_seconds(seconds);
    for (int i = 0; now < end; ++i) {
      now += kImuPeriod;
      watch.add("/imu", now - delay + imu_clock, now);
      if (lidar && i % kImuPerScan == 0) watch.add("/points", now - 2 * delay + lidar_clock, now);
    }
  }
};

TEST(ClockWatch, LetsSteadyClocksBe) {
  Robot robot;
  robot.run(10.0);
  robot.imu_clock += kMillisecond * 300;  // an hour of 80 ppm
  robot.lidar_clock += kMillisecond * 300;
  robot.run(10.0);
  EXPECT_EQ(robot.watch.broken(), "");
  EXPECT_TRUE(robot.watch.differing().empty());
}

TEST(ClockWatch, NamesStampsThatStay) {
  Robot robot;
  for (int i = 0; i < 800; ++i) {
    robot.watch.add("/other", -kSecond, robot.now);  // 2^32-1 s, of which ROS 2 has 31 bits
    if (i == 400) EXPECT_TRUE(robot.watch.differing().empty()) << "two seconds";
    robot.run(0.005);
  }
  EXPECT_EQ(robot.watch.broken(), "");
  ASSERT_EQ(robot.watch.differing().size(), 1U);
  EXPECT_EQ(robot.watch.differing()[0], "the stamps of /other stay at -1.0 s");
  robot.watch.add("/other", robot.now - 700 * kSecond, robot.now);
  EXPECT_TRUE(robot.watch.differing().empty()) << "set";
}

TEST(ClockWatch, IsBrokenASecondAfterAllClocksJumped) {
  for (const double jump : {-3600.0, -8.0, 2.0, 1e6}) {
    Robot robot;
    robot.run(5.0);
    robot.imu_clock += from_seconds(jump);
    robot.lidar_clock += from_seconds(jump);
    robot.run(0.9);
    EXPECT_EQ(robot.watch.broken(), "") << jump;
    robot.run(0.3);
    EXPECT_NE(robot.watch.broken().find("/imu by"), std::string::npos) << robot.watch.broken();
    EXPECT_NE(robot.watch.broken().find("/points by"), std::string::npos) << robot.watch.broken();
  }
}

// A program that was stopped reads the clouds that waited, late, before the IMU goes on.
TEST(ClockWatch, ABacklogOfOneTopicIsNoJumpOfAllClocks) {
  Robot robot;
  robot.run(5.0);
  robot.now += 8 * kSecond;
  for (int i = 0; i < 20; ++i) {
    robot.now += 100 * kMillisecond;
    robot.watch.add("/points", robot.now - 5 * kSecond + robot.lidar_clock, robot.now);
  }
  robot.run(5.0);
  EXPECT_EQ(robot.watch.broken(), "");
  EXPECT_TRUE(robot.watch.differing().empty());
}

TEST(ClockWatch, NamesTheOneClockThatJumped) {
  Robot robot;
  robot.run(5.0);
  robot.lidar_clock -= 60 * kSecond;
  robot.run(5.0);
  EXPECT_EQ(robot.watch.broken(), "") << "the IMU goes on";
  EXPECT_EQ(robot.watch.differing(),
            std::vector<std::string>{"the clock of /points jumped by -60.0 s"});
  robot.lidar_clock += 60 * kSecond;
  robot.run(0.5);
  EXPECT_TRUE(robot.watch.differing().empty()) << "it is back";
}

TEST(ClockWatch, SilentTopicsDoNotCount) {
  Robot robot;
  robot.run(5.0);
  robot.lidar = false;  // its driver has ended
  robot.run(2.0);
  robot.imu_clock -= 100 * kSecond;
  robot.run(1.5);
  EXPECT_NE(robot.watch.broken(), "");
}

TEST(ClockWatch, LateMessagesAreNoJump) {
  Robot robot;
  robot.run(5.0);
  // The network was away for four seconds, then everything arrives within a second.
  const Time silent_from = robot.now;
  robot.now += 4 * kSecond;
  for (Time stamp = silent_from; stamp < silent_from + 4 * kSecond; stamp += kImuPeriod) {
    robot.now += kMillisecond;
    robot.watch.add("/imu", stamp + robot.imu_clock, robot.now);
  }
  robot.run(5.0);
  EXPECT_EQ(robot.watch.broken(), "");
}

TEST(ClockWatch, TimesOfArrivalDoNotGoBack) {
  Robot robot;
  robot.run(5.0);
  robot.now -= kSecond / 2;  // of another publisher
  robot.run(0.1);
  EXPECT_EQ(robot.watch.broken(), "");
  robot.now -= 20 * kSecond;
  robot.run(0.1);
  EXPECT_NE(robot.watch.broken().find("went back by 20."), std::string::npos)
      << robot.watch.broken();
}

TEST(ClockWatch, TwoClocksUnderOneNameAreNoJump) {
  Robot robot;
  robot.lidar = false;
  robot.run(2.0);
  for (int i = 0; i < 1000; ++i) {
    robot.now += kImuPeriod;
    robot.watch.add("/imu", robot.now + robot.imu_clock - (i % 2) * 50 * kSecond, robot.now);
  }
  EXPECT_EQ(robot.watch.broken(), "");
}

}  // namespace
}  // namespace aims
