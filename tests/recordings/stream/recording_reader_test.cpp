// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/recording_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <numbers>
#include <tuple>

#include "recordings/inspection/bag_check.hpp"
#include "recordings/inspection/bag_info.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/recordings/stream/robot_recording.hpp"

namespace aims {
namespace {

using test::kMounted;
using test::kStart;
using test::RawCloud;
using test::Recording;
using test::RobotRecording;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class RecordingReaderTest : public test::RecordingTest {};

MessageBytes odometry(Time stamp, const std::string& child = "base", double speed = 0.5) {
  OdometryContent content;
  content.linear_velocity.x() = speed;
  content.pose.translation.x() = speed * to_seconds(stamp - kStart);
  return odometry_message({0, stamp, "odom"}, child, content);
}

TEST_F(RecordingReaderTest, SeveralSuitableTopicsAreAnErrorThatNamesThem) {
  RobotRecording robot(bag());
  robot.add_imu(kStart, 5);
  robot.add_cloud(RawCloud::of(kStart, {{1, 2, 3, 0}}), kStart, "/left/points");
  robot.add_cloud(RawCloud::of(kStart, {{1, 2, 3, 0}}), kStart, "/right/points");
  robot.close();
  EXPECT_EQ(test::read_recording(bag()).error,
            bag().string() +
                ": several topics are sensor_msgs/PointCloud2 or a livox CustomMsg: "
                "/left/points, /right/points; choose one with recording.topics.lidar (or none)");
  RecordingConfig config;
  config.topics.lidar = "/left/points";
  EXPECT_EQ(test::read_recording(bag(), config).error, "");
}

TEST_F(RecordingReaderTest, ATruthUnderAnotherNameIsNotReadAndNamed) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 200);
  robot.add_clouds(kStart, 5);
  robot.add("/mocap/odom", odometry_type(), kStart, odometry(kStart));
  robot.close();
  EXPECT_TRUE(test::read_recording(bag()).noted(
      "/mocap/odom may be the truth and is not read: to score against it, "
      "--topics truth=/mocap/odom"));
  RecordingConfig config;
  config.topics.truth = "none";
  EXPECT_FALSE(test::read_recording(bag(), config).noted("may be the truth"));
}

TEST_F(RecordingReaderTest, ALidarThatStartsAMinuteLaterIsReadLikeAnyOther) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 3600);
  robot.add_clouds(kStart + 65 * kSecond, 10);
  robot.close();
  const Recording read = test::read_recording(bag());
  EXPECT_TRUE(read.setup.has_point_times);
  EXPECT_FALSE(read.noted("NO TRANSFORM"));
  EXPECT_TRUE(read.setup.warnings.empty());
  EXPECT_TRUE(read.noted("the estimate begins 3 s before the first one"));
  const Time first = test::scans_of(read.deliveries).at(0)->stamp;
  EXPECT_NEAR(to_seconds(first - test::imu_of(read.deliveries).at(0).stamp), 3.0, 0.2);
}

/// What is warned of when clouds of frame "lidar" are followed by clouds of that frame.
std::vector<ReadingWarning> warnings_after(const std::filesystem::path& file,
                                           const std::string& frame) {
  std::filesystem::remove(file);
  RobotRecording robot(file);
  auto mounted = kMounted;
  mounted.push_back({"lidar", "top", {}});
  mounted.push_back({"lidar", "rear", {Eigen::Quaterniond::Identity(), {-0.4, 0.0, 0.3}}});
  robot.add_transforms(mounted);
  robot.add_imu(kStart, 100);
  robot.add_clouds(kStart, 12);
  for (int k = 12; k < 15; ++k) {
    RawCloud cloud = RawCloud::of(kStart + k * 100 * kMillisecond, {{1, 2, 3, 0}, {1, 2, 3, 0.09}});
    cloud.frame = frame;
    robot.add_cloud(cloud, cloud.stamp + 100 * kMillisecond);
  }
  robot.close();
  const Recording read = test::read_recording(file);
  EXPECT_EQ(read.counts.contains("lidar_frame_changed"), !read.setup.warnings.empty());
  return read.setup.warnings;
}

TEST_F(RecordingReaderTest, CloudsThatGoOnInAnotherFrameAreAWarningThatSaysWhereItIs) {
  const auto rear = warnings_after(bag(), "rear");
  ASSERT_EQ(rear.size(), 1U) << "once";
  EXPECT_EQ(rear[0].reason, "frame of the LiDAR changed");
  EXPECT_NE(rear[0].text.find(", in 'lidar' before: which lies 0.500 m"), std::string::npos)
      << rear[0].text;
  EXPECT_TRUE(rear[0].concerns(true, false));
  EXPECT_FALSE(rear[0].concerns(false, true)) << "legs alone";
  const auto nowhere = warnings_after(bag(), "nowhere");
  ASSERT_EQ(nowhere.size(), 1U);
  EXPECT_NE(nowhere[0].text.find("no transform between them"), std::string::npos);
  EXPECT_TRUE(warnings_after(bag(), "top").empty()) << "the same place";
  EXPECT_TRUE(warnings_after(bag(), "/lidar").empty()) << "the same frame";
}

TEST_F(RecordingReaderTest, ARecorderClockThatIsSetBackByMoreThanTheRecordingChangesNoOrder) {
  const Time start = 1'700'000'000 * kSecond;
  for (const Duration back : {7 * kSecond, 3600 * kSecond}) {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_transforms(kMounted);
    // All that follows 1 s is recorded earlier, so that it comes first.
    for (int k = 0; k < 150; ++k) {
      const Time stamp = start + k * 20 * kMillisecond;
      const Time recorded = stamp + kMillisecond - (k < 50 ? 0 : back);
      ImuSample sample;
      sample.stamp = stamp;
      sample.specific_force = {0.0, 0.0, 9.81};
      robot.add("/imu", imu_type(), recorded, imu_message({0, stamp, "imu"}, sample));
    }
    robot.add_clouds(start, 8);
    robot.close();
    const Recording read = test::read_recording(bag());
    const auto imu = test::imu_of(read.deliveries);
    ASSERT_EQ(imu.size(), 150U);
    for (std::size_t i = 1; i < imu.size(); ++i) EXPECT_GT(imu[i].stamp, imu[i - 1].stamp) << i;
  }
}

TEST_F(RecordingReaderTest, StampsOfZeroAmongOthersSayNothingOfTheClocks) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  const Time start = 1'700'000'000 * kSecond;
  for (int k = 0; k < 100; ++k) {
    const Time stamp = start + k * 20 * kMillisecond;
    ImuSample sample;
    sample.stamp = k % 4 == 0 ? 0 : stamp;
    sample.specific_force = {0.0, 0.0, 9.81};
    robot.add("/imu", imu_type(), stamp + kMillisecond,
              imu_message({0, sample.stamp, "imu"}, sample));
  }
  robot.add_clouds(start, 8);
  robot.close();
  const Recording read = test::read_recording(bag());
  EXPECT_FALSE(read.noted("they are shifted by it"));
  EXPECT_TRUE(read.setup.warnings.empty());
  EXPECT_EQ(test::imu_of(read.deliveries).size(), 75U);
  EXPECT_EQ(read.counts.at("stamp_not_set"), 25);
}

TEST_F(RecordingReaderTest, ADelayOfTheImuTakesItsOtherClockBack) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  const Time start = 1'700'000'000 * kSecond;
  for (int k = 0; k < 100; ++k) {
    ImuSample sample;
    sample.stamp = 12 * kSecond + k * 20 * kMillisecond;  // since boot
    sample.specific_force = {0.0, 0.0, 9.81};
    robot.add("/imu", imu_type(), start + k * 20 * kMillisecond + kMillisecond,
              imu_message({0, sample.stamp, "imu"}, sample));
  }
  robot.add_clouds(start, 8);
  robot.close();
  RecordingConfig config;
  config.imu_delay = to_seconds(12 * kSecond - start);
  const Recording read = test::read_recording(bag(), config);
  EXPECT_FALSE(read.noted("they are shifted by it"));
  EXPECT_NEAR(to_seconds(test::imu_of(read.deliveries).at(0).stamp - start), 0.0, 1e-6);
  const auto first = std::ranges::find_if(read.deliveries, [](const Delivery& each) {
    return std::holds_alternative<ImuSample>(each.measurement);
  });
  EXPECT_NEAR(to_seconds(first->arrival - start), 0.0, 0.1);
}

constexpr Time kEpochStart = 1'700'000'000 * kSecond;

TEST_F(RecordingReaderTest, AMessageRecordedBeforeTheClockWasSetTakesThePlaceOfItsStamp) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  ImuSample sample;
  sample.stamp = kEpochStart + 990 * kMillisecond;
  robot.add("/imu", imu_type(), 1, imu_message({0, sample.stamp, "imu"}, sample));
  robot.add_imu(kEpochStart, 100);
  robot.add_clouds(kEpochStart, 10);
  robot.close();
  const Recording read = test::read_recording(bag());
  EXPECT_TRUE(read.setup.has_point_times);
  EXPECT_EQ(read.counts, (std::map<std::string, int>{{"recorded_before_their_stamp", 1}}));
  Time last = 0;
  for (const Delivery& each : read.deliveries) {
    EXPECT_GE(each.arrival, last);
    last = each.arrival;
  }
}

TEST_F(RecordingReaderTest, ARecorderClockThatIsSetBackChangesNoOrder) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  for (int k = 0; k < 300; ++k) {
    ImuSample sample;
    sample.stamp = kEpochStart + k * 20 * kMillisecond;
    sample.specific_force.z() = 9.81;
    const Time recorded = sample.stamp + kMillisecond - (k >= 150 ? 2 * kSecond : 0);
    robot.add("/imu", imu_type(), recorded, imu_message({0, sample.stamp, "imu"}, sample));
  }
  robot.add_clouds(kEpochStart, 5);
  robot.close();
  const Recording read = test::read_recording(bag());
  EXPECT_EQ(read.counts, (std::map<std::string, int>{{"recorded_before_their_stamp", 150}}));
  int samples = 0;
  Time last = 0;
  for (const Delivery& each : read.deliveries) {
    const auto* sample = std::get_if<ImuSample>(&each.measurement);
    if (sample == nullptr) continue;
    EXPECT_GT(sample->stamp, last);
    EXPECT_EQ(each.arrival, sample->stamp + kMillisecond);
    last = sample->stamp;
    ++samples;
  }
  EXPECT_EQ(samples, 300);
}

/// An IMU at 50 Hz and clouds at 10 Hz over 6 s; the recorder's clock is set back at 3 s.
Recording read_set_back(const std::filesystem::path& bag, Duration back) {
  std::filesystem::remove(bag);
  RobotRecording robot(bag);
  robot.add_transforms(kMounted);
  const auto recorded = [&](Time at) { return at - (at >= kEpochStart + 3 * kSecond ? back : 0); };
  for (int k = 0; k < 300; ++k) {
    ImuSample sample;
    sample.stamp = kEpochStart + k * 20 * kMillisecond;
    sample.specific_force.z() = 9.81;
    robot.add("/imu", imu_type(), recorded(sample.stamp + kMillisecond),
              imu_message({0, sample.stamp, "imu"}, sample));
    if (k % 5 != 0) continue;
    const Time stamp = sample.stamp - 100 * kMillisecond;
    robot.add_cloud(RawCloud::of(stamp, {{1, 2, 0, 0}, {2, 1, 1, 0.09F}}),
                    recorded(sample.stamp + 2 * kMillisecond));
  }
  robot.close();
  return test::read_recording(bag);
}

TEST_F(RecordingReaderTest, AClockThatIsSetBackBeforeTheFirstScansChangesNoOrder) {
  for (const Duration back : {kSecond / 2, kSecond, 4 * kSecond}) {
    const Recording read = read_set_back(bag(), back);
    EXPECT_FALSE(read.counts.contains("lidar_stamp_not_increasing")) << back;
    EXPECT_FALSE(read.counts.contains("imu_stamp_not_increasing")) << back;
    EXPECT_FALSE(read.noted("if their clocks differ")) << back;
    EXPECT_EQ(test::scans_of(read.deliveries).size(), 60U) << back;
  }
}

TEST_F(RecordingReaderTest, OneRecordTimeForAllMessagesGivesWayToStamps) {
  for (const Time recorded : {Time{1}, kEpochStart}) {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add("/tf_static", transforms_type(), recorded, transforms_message(0, kMounted));
    for (int k = 0; k < 100; ++k) {
      ImuSample sample;
      sample.stamp = kEpochStart + k * 20 * kMillisecond;
      robot.add("/imu", imu_type(), recorded, imu_message({0, sample.stamp, "imu"}, sample));
      if (k % 5 != 4) continue;
      robot.add_cloud(
          RawCloud::of(sample.stamp - 80 * kMillisecond, {{1, 2, 0, 0}, {2, 1, 1, 0.08F}}),
          recorded);
    }
    robot.close();
    const Recording read = test::read_recording(bag());
    ASSERT_EQ(read.error, "");
    EXPECT_TRUE(read.noted("record times are all the same"));
    EXPECT_TRUE(read.counts.empty()) << read.counts.begin()->first;
    EXPECT_FALSE(read.noted("NO TRANSFORM"));
    const auto scans = test::scans_of(read.deliveries);
    ASSERT_EQ(scans.size(), 20U);
    EXPECT_EQ(scans[3]->stamp, kEpochStart + 300 * kMillisecond);
  }
}

TEST_F(RecordingReaderTest, SingleStampsOfZeroAreLeftOut) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  ImuSample unset;
  for (int k = 0; k < 5; ++k) {
    robot.add("/imu", imu_type(), kEpochStart - kSecond, imu_message({0, 0, "imu"}, unset));
  }
  robot.add_imu(kEpochStart, 100);
  robot.add_clouds(kEpochStart, 10);
  robot.close();
  const Recording read = test::read_recording(bag());
  EXPECT_EQ(read.counts, (std::map<std::string, int>{{"stamp_not_set", 5}}));
}

TEST_F(RecordingReaderTest, AClockThatStartsAtZeroHasThatStamp) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  for (int k = 0; k < 100; ++k) {
    ImuSample sample;
    sample.stamp = k * 20 * kMillisecond;
    sample.specific_force.z() = 9.81;
    robot.add("/imu", imu_type(), kEpochStart + sample.stamp,
              imu_message({0, sample.stamp, "imu"}, sample));
  }
  for (int k = 0; k < 20; ++k) {
    const Time fired = k * 100 * kMillisecond;
    robot.add_cloud(RawCloud::of(fired, {{1, 2, 0, 0}, {2, 1, 1, 0.08F}}),
                    kEpochStart + fired + 100 * kMillisecond);
  }
  robot.close();
  const Recording read = test::read_recording(bag());
  ASSERT_EQ(read.error, "");
  EXPECT_TRUE(read.counts.empty()) << read.counts.begin()->first;
  EXPECT_EQ(test::scans_of(read.deliveries).size(), 20U);
}

TEST_F(RecordingReaderTest, ALidarClockSinceBootIsAWarningWithTheDelayThatCorrectsIt) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  robot.add_imu(kEpochStart, 100);
  for (int k = 0; k < 10; ++k) {
    const Time fired = kEpochStart + k * 100 * kMillisecond;
    robot.add_cloud(RawCloud::of(fired - kEpochStart + kSecond, {{1, 2, 0, 0}, {2, 1, 1, 0.09F}}),
                    fired + 101 * kMillisecond);
  }
  robot.close();
  EXPECT_TRUE(test::read_recording(bag()).noted("set recording.lidar_delay=-1699999999.000"));
  RecordingConfig corrected;
  corrected.lidar_delay = -1699999999.0;
  EXPECT_FALSE(test::read_recording(bag(), corrected).noted("set recording.lidar_delay"));
}

TEST_F(RecordingReaderTest, StatesWhichPartsOfCloudsAndImuTheRecordingHolds) {
  RobotRecording robot(bag());
  robot.add_imu(kStart, 50);
  robot.add_clouds(kStart, 8);
  robot.close();
  const RecordingSetup timed = test::read_recording(bag()).setup;
  EXPECT_TRUE(timed.has_point_times);
  EXPECT_EQ(timed.rings.count, 8) << "derived from the elevations";
  EXPECT_FALSE(timed.has_orientation);
}

TEST_F(RecordingReaderTest, ATimeThatIsTheSameForAllPointsIsNone) {
  RobotRecording robot(bag());
  robot.add_imu(kStart, 50);
  for (int k = 0; k < 8; ++k) {
    const Time stamp = kStart + k * 100 * kMillisecond;
    robot.add_cloud(RawCloud::of(stamp, {{1, 2, 3, 0}, {2, 1, 3, 0}}), stamp);
  }
  robot.close();
  EXPECT_FALSE(test::read_recording(bag()).setup.has_point_times);
}

TEST_F(RecordingReaderTest, AMissingTopicIsAnErrorThatListsTheExistingOnes) {
  RobotRecording robot(bag());
  robot.add_imu(kStart, 5);
  robot.close();
  EXPECT_EQ(test::read_recording(bag()).error,
            bag().string() +
                ": no topic is sensor_msgs/PointCloud2 or a livox CustomMsg "
                "(recording.topics.lidar; 'none' to do without); it has /imu (sensor_msgs/Imu)");
  RecordingConfig config;
  config.topics.lidar = "/imux";
  EXPECT_EQ(test::read_recording(bag(), config).error,
            bag().string() +
                ": no topic '/imux' (recording.topics.lidar); did you mean '/imu'?; it has /imu "
                "(sensor_msgs/Imu)");
  config.topics.lidar = "/imu";
  EXPECT_EQ(test::read_recording(bag(), config).error,
            bag().string() +
                ": topic '/imu' (recording.topics.lidar) is sensor_msgs/Imu, expected "
                "sensor_msgs/PointCloud2 or a livox CustomMsg");
  config.topics.lidar = "none";
  EXPECT_EQ(test::read_recording(bag(), config).error, "");
}

TEST_F(RecordingReaderTest, AnUnreadableDefinitionIsAnErrorThatNamesTheTopic) {
  RobotRecording robot(bag());
  robot.add_clouds(kStart, 2);
  MessageType broken = imu_type();
  broken.definition = "NoSuchType field\n";
  robot.add("/imu", broken, kStart, MessageBytes());
  robot.close();
  const std::string error = test::read_recording(bag()).error;
  EXPECT_EQ(error.find(bag().string() + ": topic '/imu': "), 0U) << error;
  EXPECT_NE(error.find("NoSuchType"), std::string::npos) << error;
}

TEST_F(RecordingReaderTest, InvalidPointsAreDroppedAndCounted) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 20);
  robot.add_clouds(kStart, 3);
  const Time stamp = kStart + 300 * kMillisecond;
  robot.add_cloud(RawCloud::of(stamp, {{1, 0, 0, 0.01F},
                                       {kNan, 0, 0, 0.02F},
                                       {0, 0, 0, 0.03F},
                                       {1, 1, 0, kNan},
                                       {1, 1, 1, -7.0F},
                                       {2, 0, std::numeric_limits<float>::infinity(), 0.04F},
                                       {2, 0, 0, 0.03F},
                                       {3, 0, 0, 0.02F}}),
                  stamp);
  robot.close();
  const Recording read = test::read_recording(bag());
  ASSERT_EQ(read.error, "");
  const auto scans = test::scans_of(read.deliveries);
  ASSERT_EQ(scans.size(), 4U);
  ASSERT_EQ(scans[3]->points.size(), 3U);
  EXPECT_EQ(scans[3]->points[0].position.x(), 1.0F);
  EXPECT_EQ(scans[3]->points[1].position.x(), 3.0F);
  EXPECT_EQ(scans[3]->points[2].position.x(), 2.0F);
  EXPECT_EQ(read.counts, (std::map<std::string, int>{{"cloud_points_not_finite", 2},
                                                     {"cloud_points_time_out_of_range", 2},
                                                     {"cloud_points_zero", 1},
                                                     {"cloud_sorted_by_time", 1}}));
}

/// Clouds whose layouts do not hold together.
std::vector<RawCloud> malformed_clouds() {
  const RawCloud good = RawCloud::of(kStart, {{1, 2, 3, 0}, {1, 2, 4, 0}});
  std::vector<RawCloud> clouds(10, good);
  clouds[0].width = 0xFFFFFFFF;
  clouds[0].height = 0xFFFFFFFF;
  clouds[1].point_step = 0;
  clouds[2].fields[2].offset = 13;
  clouds[3].row_step = 8;
  clouds[4].fields.erase(clouds[4].fields.begin() + 1);
  clouds[5].fields[1].offset = 2;  // over x
  clouds[6].data.resize(31);
  clouds[7].fields[3].type = 99;
  clouds[8].fields[3].count = 0xFFFFFFFF;
  clouds[9].fields[0].type = 2;  // bytes are no coordinates
  return clouds;
}

TEST_F(RecordingReaderTest, MalformedCloudsAreCounted) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 20);
  robot.add_clouds(kStart, 3);
  for (RawCloud& cloud : malformed_clouds()) robot.add_cloud(cloud, kStart + kSecond);
  robot.close();
  const Recording read = test::read_recording(bag());
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(test::scans_of(read.deliveries).size(), 3U);
  EXPECT_EQ(read.counts, (std::map<std::string, int>{{"lidar_malformed", 10}}));
}

TEST_F(RecordingReaderTest, NoReadableCloudAtAllIsAnError) {
  std::size_t number = 0;
  for (RawCloud& cloud : malformed_clouds()) {
    const std::filesystem::path file = folder_.path() / (std::to_string(number++) + ".bag");
    RobotRecording robot(file);
    robot.add_imu(kStart, 5);
    robot.add_cloud(cloud, kStart + kSecond);
    robot.close();
    const std::string error = test::read_recording(file).error;
    EXPECT_EQ(error.find(file.string() + ": topic '/points': "), 0U) << error;
  }
}

TEST_F(RecordingReaderTest, TruncatedMessagesAreCounted) {
  RobotRecording robot(bag());
  robot.add_imu(kStart, 10);
  robot.add_clouds(kStart, 2);
  MessageBytes shorter;
  shorter.append(imu_message({}, {}).view().data(), 50);
  robot.add("/imu", imu_type(), kStart + kSecond, shorter);
  robot.close();
  const Recording read = test::read_recording(bag());
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.counts, (std::map<std::string, int>{{"imu_malformed", 1}}));
  EXPECT_EQ(test::imu_of(read.deliveries).size(), 10U);
}

TEST_F(RecordingReaderTest, WithoutTfTheExtrinsicsAreIdentityAndNoted) {
  RobotRecording robot(bag());
  robot.add_imu(kStart, 10);
  robot.add_clouds(kStart, 2);
  robot.close();
  const Recording read = test::read_recording(bag());
  ASSERT_EQ(read.error, "");
  EXPECT_TRUE(
      read.noted("NO TRANSFORM from 'imu' to 'lidar' in tf: identity is assumed. Set "
                 "recording.T_imu_lidar.translation"));
  EXPECT_TRUE(read.noted("no leg odometry"));
  EXPECT_FALSE(read.setup.has_legs);
}

TEST_F(RecordingReaderTest, TfReplacesAMissingTfStatic) {
  RobotRecording robot(bag());
  Pose mounted;
  mounted.translation = {0.1, 0.2, 0.3};
  robot.add_transforms({{"imu", "lidar", mounted}}, "/tf");
  robot.add_imu(kStart, 10);
  robot.add_clouds(kStart, 2);
  robot.close();
  const Recording read = test::read_recording(bag());
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.setup.rig.T_body_lidar.translation, mounted.translation);
  EXPECT_TRUE(read.noted("imu -> lidar: from /tf at the start, assumed fixed"));
}

TEST_F(RecordingReaderTest, TopicsWithoutStampsUseRecordTimes) {
  RobotRecording robot(bag());
  for (int k = 0; k < 10; ++k) {
    robot.add("/imu", imu_type(), kStart + k * 20 * kMillisecond, imu_message({0, 0, "imu"}, {}));
  }
  robot.add_clouds(kStart, 3);
  robot.close();
  const Recording read = test::read_recording(bag());
  ASSERT_EQ(read.error, "");
  EXPECT_TRUE(read.noted("/imu: stamps are all zero, record times are used"));
  const auto samples = test::imu_of(read.deliveries);
  ASSERT_EQ(samples.size(), 10U);
  EXPECT_EQ(samples[3].stamp, kStart + 60 * kMillisecond);
}

TEST_F(RecordingReaderTest, ArrivalsOfAnotherClockAreShiftedToTheSensors) {
  RobotRecording robot(bag());
  constexpr Duration kAhead = 1'000'000 * kSecond;
  for (int k = 0; k < 100; ++k) {
    ImuSample sample;
    sample.stamp = kStart + k * 20 * kMillisecond;
    sample.specific_force.z() = 9.81;
    robot.add("/imu", imu_type(), sample.stamp + kAhead,
              imu_message({0, sample.stamp, "imu"}, sample));
  }
  robot.add_cloud(RawCloud::of(kStart, {{1, 2, 3, 0}, {1, 2, 3, 0.09F}}),
                  kStart + kAhead + 120 * kMillisecond);
  robot.close();
  const Recording read = test::read_recording(bag());
  ASSERT_EQ(read.error, "");
  EXPECT_TRUE(read.noted("arrivals are 1000000.000 s ahead of the sensors'"));
  EXPECT_EQ(read.deliveries.front().arrival, kStart);
}

TEST_F(RecordingReaderTest, StampsFarFromThoseOfTheImuAreNoted) {
  RobotRecording robot(bag());
  robot.add_imu(kStart, 100);
  robot.add_clouds(kStart, 5);
  for (int k = 0; k < 20; ++k) {
    const Time now = kStart + k * 10 * kMillisecond;
    robot.add("/odom", odometry_type(), now, odometry(now - 3 * kSecond));
  }
  robot.close();
  EXPECT_TRUE(
      test::read_recording(bag()).noted("/odom: stamps are 2.999 s behind those of other "
                                        "topics: set recording.leg_delay"));
}

TEST_F(RecordingReaderTest, NumbersThatAreNotFiniteAreCounted) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 20);
  robot.add_clouds(kStart, 3);
  ImuSample bad;
  bad.stamp = kStart + kSecond;
  bad.angular_velocity.x() = std::nan("");
  robot.add("/imu", imu_type(), bad.stamp, imu_message({0, bad.stamp, "imu"}, bad));
  robot.add("/odom", odometry_type(), bad.stamp, odometry(bad.stamp, "base", std::nan("")));
  robot.close();
  const Recording read = test::read_recording(bag());
  EXPECT_EQ(read.counts,
            (std::map<std::string, int>{{"imu_not_finite", 1}, {"legs_not_finite", 1}}));
  EXPECT_EQ(test::imu_of(read.deliveries).size(), 21U);
}

TEST_F(RecordingReaderTest, APoseWithoutRotationBecomesIdentityAndIsCounted) {
  RobotRecording robot(bag());
  robot.add_imu(kStart, 20);
  robot.add_clouds(kStart, 3);
  OdometryContent content;
  content.pose.rotation.coeffs().setZero();
  robot.add("/odom", odometry_type(), kStart,
            odometry_message({0, kStart, "odom"}, "base", content));
  robot.close();
  const Recording read = test::read_recording(bag());
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(test::legs_of(read.deliveries).at(0).T_odom_base.rotation.w(), 1.0);
  EXPECT_EQ(read.counts, (std::map<std::string, int>{{"pose_without_rotation", 1}}));
}

TEST_F(RecordingReaderTest, TruthOfAnotherFrameIsTransformedToTheBody) {
  RobotRecording robot(bag());
  Pose mounted;
  mounted.translation = {0.5, 0.0, 0.0};
  robot.add_transforms({{"imu", "lidar", {}}, {"imu", "base", mounted}});
  robot.add_imu(kStart, 20);
  robot.add_clouds(kStart, 3);
  for (int k = 0; k < 5; ++k) {
    const Time now = kStart + k * 10 * kMillisecond;
    robot.add("/mocap", odometry_type(), now, odometry(now));
    robot.add("/legs", odometry_type(), now, odometry(now));
  }
  robot.close();
  RecordingConfig config;
  config.topics.truth = "/mocap";
  config.topics.leg_odometry = "/legs";
  const Recording read = test::read_recording(bag(), config);
  ASSERT_EQ(read.error, "");
  ASSERT_EQ(read.truth.size(), 5U);
  EXPECT_NEAR(read.truth[4].pose.translation.x(), 0.5 * 0.04 - 0.5, 1e-12);
  EXPECT_EQ(test::legs_of(read.deliveries).size(), 5U);
}

TEST_F(RecordingReaderTest, AGapOfAYearIsSkippedAtOnce) {
  RobotRecording robot(bag());
  robot.add_imu(kStart, 5);
  robot.add_imu(kStart + 365LL * 86400 * kSecond, 5);
  robot.close();
  RecordingConfig config;
  config.topics.lidar = "none";
  auto reader = RecordingReader::open(bag(), config);
  ASSERT_TRUE(reader) << reader.error().message;
  std::vector<Delivery> deliveries;
  ASSERT_EQ(reader->advance(kSecond, deliveries), true);
  EXPECT_EQ(deliveries.size(), 5U);
  ASSERT_EQ(reader->advance(kSecond, deliveries), false);
  EXPECT_EQ(deliveries.size(), 10U);
  EXPECT_EQ(reader->advance(kSecond, deliveries), false);
}

TEST_F(RecordingReaderTest, ImuUnitsFollowFromTheNormOrTheConfiguration) {
  const auto read = [&](double force, const RecordingConfig& config) {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_imu(kStart, 5, force);
    robot.add_clouds(kStart, 3);
    robot.close();
    return test::read_recording(bag(), config);
  };
  const auto first_force = [](const Recording& recording) {
    return test::imu_of(recording.deliveries).at(0).specific_force.z();
  };
  EXPECT_DOUBLE_EQ(first_force(read(0.98, {})), 0.98 * 9.80665);
  EXPECT_EQ(first_force(read(9.6, {})), 9.6);
  const Recording odd = read(3.0, {});
  EXPECT_EQ(first_force(odd), 3.0);
  EXPECT_TRUE(odd.noted("neither gravity in m/s^2 nor in g"));
  RecordingConfig config;
  config.imu_unit = ImuUnit::kGravities;
  EXPECT_DOUBLE_EQ(first_force(read(3.0, config)), 3.0 * 9.80665);
}

TEST_F(RecordingReaderTest, AnAccelerometerThatDoesNotMeasureGravityAtRestIsNamed) {
  // Of a robot that stands for 5 s and measures these forces, at first and later.
  const auto is_named = [this](double first, double later) {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_transforms(kMounted);
    robot.add_imu(kStart, 50, first);
    robot.add_imu(kStart + kSecond, 200, later);
    robot.add_clouds(kStart, 3);
    robot.close();
    return test::read_recording(bag()).noted("% off gravity");
  };
  EXPECT_TRUE(is_named(10.8, 10.8));
  EXPECT_TRUE(is_named(9.0, 9.0));
  EXPECT_FALSE(is_named(9.6, 9.6)) << "a bias";
  EXPECT_FALSE(is_named(9.0, 9.7)) << "a filter that settles";
  EXPECT_FALSE(is_named(1.0, 1.0)) << "in g";
}

TEST_F(RecordingReaderTest, AGyroInDegreesIsConvertedWhereTheConfigurationSaysSo) {
  RobotRecording robot(bag());
  ImuSample sample;
  sample.stamp = kStart;
  sample.angular_velocity = {90.0, 0.0, -180.0};
  sample.specific_force = {0.0, 0.0, 9.81};
  for (int k = 0; k < 5; ++k, sample.stamp += 20 * kMillisecond) {
    robot.add("/imu", imu_type(), sample.stamp + kMillisecond,
              imu_message({0, sample.stamp, "imu"}, sample));
  }
  robot.add_clouds(kStart, 3);
  robot.close();
  RecordingConfig config;
  const Recording as_given = test::read_recording(bag(), config);
  EXPECT_TRUE(as_given.noted("recording.gyro_unit=deg/s"));
  config.gyro_unit = GyroUnit::kDegrees;
  const Recording read = test::read_recording(bag(), config);
  const Eigen::Vector3d turn = test::imu_of(read.deliveries).at(0).angular_velocity;
  EXPECT_NEAR((turn - Eigen::Vector3d(0.5, 0.0, -1.0) * std::numbers::pi).norm(), 0.0, 1e-12);
}

/// An IMU of 50 Hz at rest, by default for 6 s, with clouds, whose stamps and record times `times`
/// changes.
using ChangeTimes = std::function<void(bool cloud, Time& stamp, Time& recorded)>;
Recording read_with_times(const std::filesystem::path& bag, const ChangeTimes& times,
                          int samples = 300) {
  RobotRecording robot(bag);
  robot.add_transforms(kMounted);
  const Time begin = 1'700'000'000 * kSecond;
  for (int k = 0; k < samples; ++k) {
    ImuSample sample;
    sample.stamp = begin + k * 20 * kMillisecond;
    sample.specific_force.z() = 9.81;
    Time recorded = sample.stamp + kMillisecond;
    times(false, sample.stamp, recorded);
    robot.add("/imu", imu_type(), recorded, imu_message({0, sample.stamp, "imu"}, sample));
    if (k % 5 != 0) continue;
    Time stamp = begin + k * 20 * kMillisecond, arrives = stamp + 101 * kMillisecond;
    times(true, stamp, arrives);
    robot.add_cloud(RawCloud::of(stamp, {{1, 2, 0, 0}, {2, 1, 1, 0.09F}}), arrives);
  }
  robot.close();
  return test::read_recording(bag);
}

constexpr Time kLeap = 1'700'000'003 * kSecond;

TEST_F(RecordingReaderTest, MissingMessagesAreCountedAndNamed) {
  // Of every so many messages of the IMU one is lost; all others come with jitter.
  const auto read = [this](int every) {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_transforms(kMounted);
    for (int k = 0; k < 1000; ++k) {
      if (every > 0 && k % every == 7) continue;
      robot.add_imu(kStart + k * 20 * kMillisecond + (k * 7919 % 1000) * 3000, 1);
    }
    robot.add_clouds(kStart, 100);
    robot.close();
    return test::read_recording(bag());
  };
  EXPECT_FALSE(read(0).noted("are missing"));
  const Recording lossy = read(10);
  EXPECT_TRUE(lossy.noted("/imu: 100 of 1000 messages are missing"));
  EXPECT_EQ(lossy.counts.at("imu_messages_missing"), 100);
  EXPECT_FALSE(read(200).noted("are missing")) << "a few";
}

TEST_F(RecordingReaderTest, MessagesOfLongGapsAreMissingToo) {
  // In 100 s, the LiDAR is silent for 3, 12 and 20 s.
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 5000);
  for (int k = 0; k < 1000; ++k) {
    if ((k >= 200 && k < 230) || (k >= 400 && k < 520) || (k >= 700 && k < 900)) continue;
    const Time stamp = kStart + k * 100 * kMillisecond;
    robot.add_cloud(RawCloud::of(stamp, {{1, 2, 0, 0}, {2, 1, 1, 0.09F}}),
                    stamp + 101 * kMillisecond);
  }
  robot.close();
  const Recording read = test::read_recording(bag());
  EXPECT_TRUE(
      read.noted("/points: 350 of 1000 messages are missing, by the gaps in their stamps "
                 "(35.0 %), 320 of them in gaps of more than 10 s, the longest of 20.1 s"));
  EXPECT_EQ(read.counts.at("lidar_messages_missing"), 350);
}

TEST_F(RecordingReaderTest, CloudsOfWhichNothingIsReadAreNotMissing) {
  // Of 100 clouds, ten are malformed, ten have no point, ten do not come.
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 500);
  for (int k = 0; k < 100; ++k) {
    if (k % 10 == 3) continue;
    const Time stamp = kStart + k * 100 * kMillisecond;
    RawCloud cloud = RawCloud::of(stamp, {{1, 2, 0, 0}, {2, 1, 1, 0.09F}});
    if (k % 10 == 5) cloud.point_step = 0;
    if (k % 10 == 7) cloud = RawCloud::of(stamp, {});
    robot.add_cloud(cloud, stamp + 101 * kMillisecond);
  }
  robot.close();
  const Recording read = test::read_recording(bag());
  EXPECT_EQ(read.counts.at("lidar_malformed"), 10);
  EXPECT_EQ(read.counts.at("cloud_empty"), 10);
  EXPECT_EQ(read.counts.at("lidar_messages_missing"), 10);
  EXPECT_TRUE(read.noted("/points: 10 of 100 messages are missing"));
}

TEST_F(RecordingReaderTest, CloudsOfWhichNothingIsReadMakeNoPauseLonger) {
  // In 60 s the LiDAR is silent for 4 s, behind 9 s of malformed clouds, and later for 12 s.
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 3000);
  for (int k = 0; k < 600; ++k) {
    if ((k >= 290 && k < 330) || (k >= 420 && k < 540)) continue;
    const Time stamp = kStart + k * 100 * kMillisecond;
    RawCloud cloud = RawCloud::of(stamp, {{1, 2, 0, 0}, {2, 1, 1, 0.09F}});
    if (k >= 200 && k < 290) cloud.point_step = 0;
    robot.add_cloud(cloud, stamp + 101 * kMillisecond);
  }
  robot.close();
  const Recording read = test::read_recording(bag());
  EXPECT_EQ(read.counts.at("lidar_malformed"), 90);
  EXPECT_TRUE(
      read.noted("/points: 160 of 600 messages are missing, by the gaps in their stamps "
                 "(26.7 %), 120 of them in gaps of more than 10 s, the longest of 12.1 s"));
}

TEST_F(RecordingReaderTest, OfTwoPublishersNoneIsMissing) {
  // The second one sends what the first one sent eight seconds before.
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  for (int k = 0; k < 3000; ++k) {
    const Time stamp = kStart + k * 20 * kMillisecond;
    robot.add_imu(stamp, 1);
    if (k % 5 != 0) continue;
    const auto add = [&](Time of) {
      robot.add_cloud(RawCloud::of(of, {{1, 2, 0, 0}, {2, 1, 1, 0.09F}}),
                      stamp + 101 * kMillisecond);
    };
    add(stamp);
    if (k > 1000) add(stamp - 8 * kSecond);
  }
  robot.close();
  const Recording read = test::read_recording(bag());
  EXPECT_FALSE(read.counts.contains("lidar_messages_missing"));
}

TEST_F(RecordingReaderTest, TopicsWithTwoPublishersAreNamedWhereALiveEstimateRecordedThem) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 500);
  robot.add("/aims/doubled", string_type(), kStart + kSecond,
            string_message("/imu has 2 publishers"));
  robot.add_clouds(kStart, 100);
  robot.close();
  const Recording read = test::read_recording(bag());
  EXPECT_TRUE(read.noted("/imu has 2 publishers, as the live estimate says that recorded it"));
  EXPECT_EQ(test::imu_of(read.deliveries).size(), 500U);
}

// The survey sees the first 100 clouds.
TEST_F(RecordingReaderTest, StampsOfOneTopicThatLeapAreNamed) {
  const Recording read = read_with_times(bag(), [](bool cloud, Time& stamp, Time&) {
    if (cloud && stamp >= kLeap) stamp += 37 * kSecond;
  });
  EXPECT_TRUE(read.noted("/points: stamps leap by 37.000 s, 3.0 s after its first message"));
  EXPECT_FALSE(read.noted("lidar_delay"));
  EXPECT_FALSE(read.counts.contains("recorded_before_their_stamp"));
}

TEST_F(RecordingReaderTest, StampsThatLeapBehindTheSurveyAreReplacedByRecordTimes) {
  constexpr Time kLate = kLeap + 11 * kSecond;  // the survey ends before it
  for (const Duration leap : {37 * kSecond, kSecond, -37 * kSecond}) {
    std::filesystem::remove(bag());
    const auto leaps = [leap](bool cloud, Time& stamp, Time&) {
      if (cloud && stamp >= kLate) stamp += leap;
    };
    const Recording read = read_with_times(bag(), leaps, 900);
    EXPECT_TRUE(read.noted("/points: stamps leap by ")) << to_seconds(leap);
    EXPECT_EQ(read.counts.at("lidar_stamps_leap"), 39) << "all but the first";
    EXPECT_FALSE(read.counts.contains("recorded_before_their_stamp"));
    EXPECT_FALSE(read.counts.contains("recorded_long_after_their_stamp"));
    int right = 0;
    for (const LidarScanPtr& scan : test::scans_of(read.deliveries)) {
      const Duration since = scan->stamp - 1'700'000'000 * kSecond;
      right += since % (kSecond / 10) == 0 && since < 18 * kSecond ? 1 : 0;
    }
    EXPECT_GE(right, 179);
  }
}

TEST_F(RecordingReaderTest, ARecorderThatIsSetBehindTheSurveyIsNoLeapOfStamps) {
  constexpr Time kLate = kLeap + 11 * kSecond;
  for (const Duration step : {-2 * kSecond, 3600 * kSecond}) {
    std::filesystem::remove(bag());
    const Recording read = read_with_times(
        bag(),
        [step](bool, Time& stamp, Time& recorded) {
          if (stamp >= kLate) recorded += step;
        },
        900);
    EXPECT_FALSE(read.noted("stamps leap by")) << to_seconds(step);
  }
}

TEST_F(RecordingReaderTest, ARecorderThatIsSetForwardMovesNoArrival) {
  const Recording read = read_with_times(bag(), [](bool, Time&, Time& recorded) {
    if (recorded >= kLeap) recorded += 3600 * kSecond;
  });
  EXPECT_FALSE(read.noted("leap"));
  EXPECT_GT(read.counts.at("recorded_long_after_their_stamp"), 100);
  for (const Delivery& each : read.deliveries) {
    ASSERT_LT(each.arrival, kLeap + 4 * kSecond);
  }
  EXPECT_EQ(test::imu_of(read.deliveries).size(), 300U);
}

TEST_F(RecordingReaderTest, ARecorderThatWasStoppedIsNoClockThatWasSet) {
  // What it had not read comes at once, when it goes on after nine seconds.
  constexpr Time kGoesOn = kLeap + 9 * kSecond;
  const auto stopped = [](bool, Time& stamp, Time& recorded) {
    if (recorded < kLeap || recorded >= kGoesOn) return;
    recorded = kGoesOn + (stamp - kLeap) / 10'000;
  };
  const Recording read = read_with_times(bag(), stopped, 900);
  EXPECT_FALSE(read.counts.contains("recorded_long_after_their_stamp"));
  EXPECT_GT(read.counts.at("read_late_by_the_recorder"), 200);
  EXPECT_FALSE(read.noted("leap"));
  EXPECT_EQ(test::imu_of(read.deliveries).size(), 900U);
}

TEST_F(RecordingReaderTest, AGapBehindALateMessageIsCounted) {
  // In 60 s, the LiDAR is silent for 20 s; the last cloud before it is written when it ends.
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 3000);
  for (int k = 0; k < 600; ++k) {
    if (k >= 300 && k < 500) continue;
    const Time stamp = kStart + k * 100 * kMillisecond;
    const Time late = k == 299 ? 20 * kSecond : 0;
    robot.add_cloud(RawCloud::of(stamp, {{1, 2, 0, 0}, {2, 1, 1, 0.09F}}),
                    stamp + late + 101 * kMillisecond);
  }
  robot.close();
  const Recording read = test::read_recording(bag());
  EXPECT_EQ(read.counts.at("lidar_messages_missing"), 200);
}

TEST_F(RecordingReaderTest, OneMessageOfTheFutureMovesNoArrival) {
  const Recording read = read_with_times(bag(), [](bool cloud, Time& stamp, Time& recorded) {
    if (!cloud && stamp == kLeap) recorded += 1'000'000 * kSecond;
  });
  EXPECT_EQ(read.counts.at("recorded_long_after_their_stamp"), 1);
  for (const Delivery& each : read.deliveries) ASSERT_LT(each.arrival, kLeap + 4 * kSecond);
}

TEST_F(RecordingReaderTest, CloudsOfAnotherFrameAreCounted) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 60);
  for (int k = 0; k < 10; ++k) {
    RawCloud cloud =
        RawCloud::of(kStart + k * 100 * kMillisecond, {{1, 2, 0, 0}, {2, 1, 1, 0.09F}});
    if (k >= 6) cloud.frame = "lidar_b";
    robot.add_cloud(cloud, cloud.stamp + 101 * kMillisecond);
  }
  robot.close();
  EXPECT_EQ(test::read_recording(bag()).counts.at("lidar_of_another_frame"), 4);
}

/// What is said of an IMU of 100 Hz that stands for `standing`, then walks; `turn` scales its gyro.
Recording read_walk(const std::filesystem::path& bag, double standing, double turn = 1.0) {
  std::filesystem::remove(bag);
  RobotRecording robot(bag);
  robot.add_transforms(kMounted);
  for (int k = 0; k < 500; ++k) {
    const double time = 0.01 * k;
    const bool walks = time >= standing;
    ImuSample sample;
    sample.stamp = kStart + k * 10 * kMillisecond;
    sample.specific_force = {0.0, 0.0, 9.81 + (walks ? 2.0 * std::sin(14.0 * time) : 0.0)};
    sample.angular_velocity.y() = walks ? turn * 0.3 * std::sin(14.0 * time) : 0.0;
    robot.add("/imu", imu_type(), sample.stamp + kMillisecond,
              imu_message({0, sample.stamp, "imu"}, sample));
  }
  robot.add_clouds(kStart, 20);
  robot.close();
  return test::read_recording(bag);
}

/// Another one for each seed.
RawCloud cloud_of(Time stamp, int seed) {
  std::vector<std::array<float, 4>> points;
  for (int i = 0; i < 50; ++i) {
    const auto place = static_cast<float>(i);
    points.push_back({4.0F, place, 0.01F * static_cast<float>(seed), 0.002F * place});
  }
  return RawCloud::of(stamp, points);
}

TEST_F(RecordingReaderTest, ALidarThatHangsIsNamed) {
  // Forty clouds, each sent so many times, the one at `hangs` for the rest.
  const auto write = [&](int hangs, int times) {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_transforms(kMounted);
    robot.add_imu(kStart, 210);
    for (int k = 0; k < 40; ++k) {
      const Time stamp = kStart + k * 100 * kMillisecond;
      robot.add_cloud(cloud_of(stamp, std::min(k / times, hangs)), stamp + 100 * kMillisecond);
    }
    robot.close();
  };
  const auto says = [](const BagInfo& info, const std::string& part) {
    return std::ranges::any_of(info.warnings, [&](const std::string& each) {
      return each.find(part) != std::string::npos;
    });
  };
  for (const auto& [hangs, times, repeated] :
       {std::tuple(100, 1, 0), {35, 1, 0}, {20, 1, 19}, {100, 2, 20}}) {
    write(hangs, times);
    const Recording read = test::read_recording(bag());
    const std::string text =
        "/points: " + std::to_string(repeated) + " of 40 clouds are the cloud before them";
    EXPECT_EQ(warns(read.setup, text), repeated > 0) << hangs;
    EXPECT_EQ(warns(read.setup, "hangs"), repeated > 0) << hangs;
    const auto info = bag_info(bag(), {}, {});
    ASSERT_TRUE(info);
    EXPECT_EQ(says(*info, text), repeated > 0) << hangs;
    const auto checks = check_bag(*info);
    EXPECT_EQ(std::ranges::count(checks, "clouds that are new", &RequirementCheck::requirement) > 0,
              repeated > 0);
  }
}

TEST_F(RecordingReaderTest, ARobotThatDoesNotStandAtTheStartIsAWarning) {
  // A second of standing is enough for the start; the recorded Go1 gets up during the other one.
  for (const double standing : {2.5, 1.2}) {
    EXPECT_TRUE(read_walk(bag(), standing).setup.warnings.empty());
  }
  for (const double standing : {0.0, 0.3}) {
    EXPECT_TRUE(read_walk(bag(), standing).noted("the robot moves in the first two seconds"));
  }
}

TEST_F(RecordingReaderTest, AGyroThatDoesNotMeasureIsAWarning) {
  EXPECT_FALSE(read_walk(bag(), 2.5).noted("the gyro is off"));
  EXPECT_TRUE(read_walk(bag(), 2.5, 0.0).noted("the gyro is off"));
}

}  // namespace
}  // namespace aims
