// SPDX-License-Identifier: BSD-3-Clause
// Clocks of sensors and recorder that differ, leap or run at another rate.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "recordings/inspection/bag_info.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"
#include "recordings/stream/record_clock.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/recordings/stream/robot_recording.hpp"

namespace aims {
namespace {

using test::kMounted;
using test::kStart;
using test::Recording;
using test::RobotRecording;

class RecordedClocks : public test::RecordingTest {};

TEST_F(RecordedClocks, ATruthOfAnotherClockIsAWarning) {
  for (const Duration ahead : {Duration{0}, 18 * kSecond}) {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_transforms(kMounted);
    robot.add_imu(kStart, 100);
    robot.add_clouds(kStart, 10);
    for (int k = 0; k < 100; ++k) {
      const Time now = kStart + k * 20 * kMillisecond;
      robot.add("/ground_truth/imu", odometry_type(), now,
                odometry_message({0, now + ahead, "world"}, "imu", {}));
    }
    robot.close();
    const Recording read = test::read_recording(bag(), {});
    EXPECT_EQ(warns(read.setup, "the truth is stamped 18.001 s ahead of the sensors"), ahead > 0);
    EXPECT_EQ(warns(read.setup, "the clock of /ground_truth/imu is off (GPS is"), ahead > 0);
  }
}

TEST_F(RecordedClocks, OfTruthAndImuTheOneIsNamedThatTheRecordTimesContradict) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  robot.add_clouds(kStart, 10);
  for (int k = 0; k < 100; ++k) {
    const Time now = kStart + k * 20 * kMillisecond;
    ImuSample sample;
    sample.stamp = now + 18 * kSecond;
    sample.specific_force.z() = 9.81;
    robot.add("/imu", imu_type(), now, imu_message({0, sample.stamp, "imu"}, sample));
    robot.add("/ground_truth/imu", odometry_type(), now,
              odometry_message({0, now, "world"}, "imu", {}));
  }
  robot.close();
  const RecordingSetup setup = test::read_recording(bag(), {}).setup;
  EXPECT_TRUE(
      warns(setup, "/imu is recorded 18.000 s before its stamps: the clock of /imu is off"));
  EXPECT_TRUE(warns(setup, "set recording.imu_delay=18.000"));
  EXPECT_FALSE(warns(setup, "--time-offset"));
}

TEST_F(RecordedClocks, ADelayThatCorrectsAClockHoldsNoMessageUpAndEndsTheWarning) {
  for (const double off : {0.3, 0.5, 0.8, 1.3, 4.0, 20.0}) {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_transforms(kMounted);
    robot.add_clouds(kStart, 20);
    for (int k = 0; k < 150; ++k) {
      const Time now = kStart + k * 20 * kMillisecond;
      ImuSample sample;
      sample.stamp = now - from_seconds(off);
      sample.specific_force.z() = 9.81;
      robot.add("/imu", imu_type(), now, imu_message({0, sample.stamp, "imu"}, sample));
      robot.add("/ground_truth/imu", odometry_type(), now,
                odometry_message({0, now, "world"}, "imu", {}));
    }
    robot.close();
    EXPECT_FALSE(test::read_recording(bag(), {}).setup.warnings.empty()) << off;
    RecordingConfig config;
    config.imu_delay = -off;
    const Recording read = test::read_recording(bag(), config);
    EXPECT_TRUE(read.setup.warnings.empty()) << off << ": " << read.setup.warnings[0].text;
    Time scan = 0;
    for (const Delivery& each : read.deliveries) {
      if (const auto* cloud = std::get_if<LidarScanPtr>(&each.measurement)) scan = (*cloud)->stamp;
      const auto* imu = std::get_if<ImuSample>(&each.measurement);
      if (imu != nullptr) {
        ASSERT_GE(imu->stamp, scan) << off << ": behind its scan";
      }
    }
  }
}

TEST_F(RecordedClocks, ADelayIsAppliedOnceWhereTheRecorderIsFarOff) {
  for (const bool late : {false, true}) {  // on a clock that is ahead, or late samples
    const double off = late ? 0.15 : 0.5;
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_transforms(kMounted);
    for (int k = 0; k < 30; ++k) {
      const Time stamp = kStart + k * 100 * kMillisecond;
      robot.add_cloud(test::RawCloud::of(stamp, {{1, 2, 3, 0}, {1, 2, 3, 0.09F}}),
                      stamp + 10 * kSecond + 100 * kMillisecond);
    }
    for (int k = 0; k < 150; ++k) {
      const Time now = kStart + k * 20 * kMillisecond;
      ImuSample sample;
      sample.stamp = now + from_seconds(off);
      sample.specific_force.z() = 9.81;
      robot.add("/imu", imu_type(), (late ? sample.stamp : now) + 10 * kSecond,
                imu_message({0, sample.stamp, "imu"}, sample));
    }
    robot.close();
    RecordingConfig config;
    config.imu_delay = late ? off : off - 0.05;
    const Recording read = test::read_recording(bag(), config);
    EXPECT_FALSE(read.deliveries.empty());
    for (const Delivery& each : read.deliveries) {
      const Duration after = each.arrival - stamp_of(each.measurement);
      ASSERT_GT(after, -10 * kMillisecond) << off;
      ASSERT_LT(after, kSecond / 5) << off;
    }
  }
}

TEST_F(RecordedClocks, RecordTimesOfARecordingPlayedAtAnotherSpeedFollowTheStamps) {
  for (const double rate : {0.25, 0.5, 0.9, 1.0, 1.1, 2.0}) {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_transforms(kMounted);
    const auto recorded = [rate](Time now) {
      return kStart + std::llround(rate * static_cast<double>(now - kStart));
    };
    for (int k = 0; k < 100; ++k) {
      const Time stamp = kStart + k * 100 * kMillisecond;
      robot.add_cloud(test::RawCloud::of(stamp, {{1, 2, 3, 0}, {1, 2, 3, 0.09F}}),
                      recorded(stamp + 100 * kMillisecond));
    }
    for (int k = 0; k < 500; ++k) {
      ImuSample sample;
      sample.stamp = kStart + k * 20 * kMillisecond;
      sample.specific_force.z() = 9.81;
      robot.add("/imu", imu_type(), recorded(sample.stamp),
                imu_message({0, sample.stamp, "imu"}, sample));
    }
    robot.close();
    const Recording read = test::read_recording(bag(), {});
    EXPECT_EQ(warns(read.setup, "times as fast as the stamps"), rate != 1.0) << rate;
    EXPECT_FALSE(warns(read.setup, "if their clocks differ")) << rate;
    EXPECT_FALSE(warns(read.setup, "cloud_stamp")) << rate;
    for (const Delivery& each : read.deliveries) {
      const Duration late = each.arrival - stamp_of(each.measurement);
      ASSERT_LT(std::abs(late), kSecond / 5) << rate;
    }
  }
}

TEST_F(RecordedClocks, ARecordingPlayedAtAnotherSpeedIsToldWithADenseImuToo) {
  for (const int hz : {400, 1000}) {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_transforms(kMounted);
    const Time begin = 2 * kSetRecordTime;  // fixed transforms are recorded at 1 s
    const auto recorded = [begin](Time now) { return begin + 95 * (now - begin) / 100; };
    for (int k = 0; k < 200; ++k) {
      const Time stamp = begin + k * 100 * kMillisecond;
      robot.add_cloud(test::RawCloud::of(stamp, {{1, 2, 3, 0}, {1, 2, 3, 0.09F}}),
                      recorded(stamp + 100 * kMillisecond));
    }
    for (int k = 0; k < 20 * hz; ++k) {
      ImuSample sample;
      sample.stamp = begin + k * kSecond / hz;
      sample.specific_force.z() = 9.81;
      robot.add("/imu", imu_type(), recorded(sample.stamp),
                imu_message({0, sample.stamp, "imu"}, sample));
    }
    robot.close();
    const Recording read = test::read_recording(bag(), {});
    EXPECT_TRUE(warns(read.setup, "times as fast as the stamps")) << hz;
    EXPECT_EQ(read.setup.warnings.size(), 2U) << hz << ": that, and of missing rings";
    EXPECT_FALSE(read.noted("they are shifted by it")) << hz;
  }
}

TEST_F(RecordedClocks, AClockThatRunsAtAnotherRateIsAWarning) {
  for (const double rate : {0.99, 1.0, 1.01}) {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_transforms(kMounted);
    robot.add_clouds(kStart, 200);
    for (int k = 0; k < 1000; ++k) {
      const Duration passed = k * 20 * kMillisecond;
      ImuSample sample;
      sample.stamp = kStart + std::llround(rate * static_cast<double>(passed));
      sample.specific_force.z() = 9.81;
      robot.add("/imu", imu_type(), kStart + passed, imu_message({0, sample.stamp, "imu"}, sample));
    }
    robot.close();
    const Recording read = test::read_recording(bag(), {});
    EXPECT_EQ(warns(read.setup, "its stamps run 1 % faster than those of /points"), rate > 1.0);
    EXPECT_EQ(warns(read.setup, "its stamps run 1 % slower than those of /points"), rate < 1.0);
    const auto info = bag_info(bag(), {}, {});
    ASSERT_TRUE(info);
    const auto says = [&](const std::string& part) {
      return std::ranges::any_of(info->warnings, [&](const std::string& each) {
        return each.find(part) != std::string::npos;
      });
    };
    EXPECT_EQ(says("its stamps run 1 % faster than those of /points"), rate > 1.0);
    EXPECT_EQ(says("its stamps run 1 % slower than those of /points"), rate < 1.0);
  }
}

TEST_F(RecordedClocks, SamplesOfAnImuThatAreSentAgainCountOnceAndInfoSaysTheSame) {
  for (const int times : {1, 4}) {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_transforms(kMounted);
    robot.add_clouds(kStart, 60);
    for (int k = 0; k < 2400; ++k) {
      ImuSample sample;
      sample.stamp = kStart + k * 5 * kMillisecond / 2;
      const double seed = k / times;
      sample.specific_force = {0.01 * std::sin(seed), 0.01 * std::cos(3.0 * seed), 9.81};
      robot.add("/imu", imu_type(), sample.stamp, imu_message({0, sample.stamp, "imu"}, sample));
    }
    robot.close();
    const Recording read = test::read_recording(bag(), {});
    EXPECT_EQ(read.noted("/imu: each sample is sent 4.0 times, and new every 10.0 ms"), times > 1);
    EXPECT_EQ(std::ssize(test::imu_of(read.deliveries)), 2400 / times);
    const auto info = bag_info(bag(), {}, {});
    ASSERT_TRUE(info);
    ASSERT_EQ(info->imus.size(), 1U);
    EXPECT_EQ(info->imus[0].new_rate_hz.has_value(), times > 1);
  }
}

TEST_F(RecordedClocks, StampsThatAreAllTheSameAreNamedByInfo) {
  for (const Time stamp : {kStart, Time{0}}) {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_transforms(kMounted);
    robot.add_clouds(kStart, 60);
    for (int k = 0; k < 600; ++k) {
      ImuSample sample;
      sample.stamp = stamp;
      sample.specific_force.z() = 9.81;
      robot.add("/imu", imu_type(), kStart + k * 10 * kMillisecond,
                imu_message({0, sample.stamp, "imu"}, sample));
    }
    robot.close();
    const auto info = bag_info(bag(), {}, {});
    ASSERT_TRUE(info);
    const std::string same = stamp == 0 ? "zero" : "the same";
    std::string others;
    for (const std::string& each : info->warnings) others += each + "\n";
    const std::string text =
        "/imu: all stamps are " + same + "; record times are used: set the stamps in the driver\n";
    EXPECT_NE(others.find(text), std::string::npos) << others;
    for (const char* wrong : {"not static", "stamps repeat", "clocks may differ", "Hz;"}) {
      EXPECT_EQ(others.find(wrong), std::string::npos) << others;
    }
    EXPECT_NEAR(info->find("/imu")->rate_hz.value_or(0.0), 100.0, 0.1);
  }
}

TEST_F(RecordedClocks, StampsOfTheImuThatLeapLateAreNoMatterOfTheRecorder) {
  for (const Duration leap : {Duration{0}, kSecond, -kSecond}) {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_transforms(kMounted);
    robot.add_clouds(kStart, 600);
    for (int k = 0; k < 3000; ++k) {
      const Time now = kStart + k * 20 * kMillisecond;
      ImuSample sample;
      sample.stamp = now + (k > 2500 ? leap : 0);
      sample.specific_force.z() = 9.81;
      robot.add("/imu", imu_type(), now, imu_message({0, sample.stamp, "imu"}, sample));
    }
    robot.close();
    const Recording read = test::read_recording(bag(), {});
    EXPECT_EQ(warns(read.setup, "/imu: stamps leap by "), leap != 0) << leap;
    EXPECT_FALSE(read.counts.contains("recorded_before_their_stamp")) << leap;
  }
}

}  // namespace
}  // namespace aims
