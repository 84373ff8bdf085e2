// SPDX-License-Identifier: BSD-3-Clause
// Assumptions about a recording that decide the result are warnings.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/recordings/stream/robot_recording.hpp"

namespace aims {
namespace {

using test::kMounted;
using test::kStart;
using test::Recording;
using test::RobotRecording;

class AssumedInputs : public test::RecordingTest {
 protected:
  /// A robot with that topic of nav_msgs/Odometry.
  Recording with_odometry(const std::string& topic, const RecordingConfig& config = {}) {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_transforms(kMounted);
    robot.add_imu(kStart, 20);
    robot.add_clouds(kStart, 3);
    for (int k = 0; k < 10; ++k) {
      const Time now = kStart + k * 20 * kMillisecond;
      robot.add(topic, odometry_type(), now, odometry_message({0, now, "odom"}, "base", {}));
    }
    robot.close();
    return test::read_recording(bag(), config);
  }

  /// A robot whose IMU has messages that `change` alters; it gives record times after the start.
  RecordingSetup with_imu(int count, const std::function<Time(int, ImuSample&)>& change) {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_transforms(kMounted);
    robot.add_clouds(kStart, 20);
    for (int k = 0; k < count; ++k) {
      ImuSample sample;
      sample.specific_force.z() = 9.81;
      const Time recorded = kStart + change(k, sample);
      if (sample.stamp == 0) sample.stamp = recorded;
      robot.add("/imu", imu_type(), recorded, imu_message({0, sample.stamp, "imu"}, sample));
    }
    robot.close();
    return test::read_recording(bag(), {}).setup;
  }

  /// An IMU, and clouds in a file of their own. `late`: when these begin after it and end after it;
  /// `recorded`, `stamped`: by how much their recorder and their LiDAR are ahead.
  void write_two_files(Duration late, Duration recorded, Duration stamped) {
    std::filesystem::remove(bag());
    std::filesystem::remove(clouds());
    RobotRecording imu(bag());
    imu.add_transforms(kMounted);
    imu.add_imu(kStart, 500);
    imu.close();
    RobotRecording lidar(clouds());
    for (int k = 0; k < 99; ++k) {
      const Time stamp = kStart + late + k * kSecond / 10;
      const auto cloud = test::RawCloud::of(stamp + stamped,
                                            {{1.0F, 0.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F, 0.09F}});
      lidar.add_cloud(cloud, stamp + kSecond / 10 + recorded);
    }
    lidar.close();
  }

  Result<RecordingReader> read_two_files() const {
    return RecordingReader::open(bag(), {}, {.with = {clouds()}});
  }

  std::filesystem::path clouds() const { return folder_.path() / "clouds.bag"; }
};

TEST_F(AssumedInputs, AMotionCaptureIsNoLegOdometry) {
  for (const char* topic : {"/mocap/odom", "/gt_odom", "/robot/gt", "/vicon/robot/odom",
                            "/optitrack/odom", "/qualisys/odom"}) {
    EXPECT_FALSE(with_odometry(topic).setup.has_legs) << topic;
  }
  RecordingConfig chosen;
  chosen.topics.leg_odometry = "/mocap/odom";
  EXPECT_TRUE(with_odometry("/mocap/odom", chosen).setup.has_legs);
  EXPECT_TRUE(with_odometry("/gtsam_legs/odom").setup.has_legs) << "no word of it is gt";
}

TEST_F(AssumedInputs, AnImuThatIsSlowIsAWarning) {
  for (const int hz : {10, 50}) {
    const auto setup = with_imu(5 * hz, [&](int k, ImuSample&) { return k * kSecond / hz; });
    EXPECT_EQ(warns(setup, "IMU of 10 Hz: a walk shakes faster"), hz == 10) << hz;
  }
}

TEST_F(AssumedInputs, AnImuWhoseBatchesShareAStampHasTheRateOfItsRecordTimes) {
  const auto setup = with_imu(500, [](int k, ImuSample& sample) {
    sample.stamp = kStart + (k / 10) * kSecond / 5;
    return k * kSecond / 50;
  });
  EXPECT_NEAR(setup.imu_rate_hz.value_or(0.0), 50.0, 0.1);
  EXPECT_TRUE(warns(setup, "/imu: stamps do not advance"));
  EXPECT_FALSE(warns(setup, "IMU of 5 Hz"));
}

TEST_F(AssumedInputs, AnImuInBatchesIsSpreadOverThem) {
  for (const Duration within : {Duration{0}, Duration{20'000}}) {
    const auto setup = with_imu(500, [within](int k, ImuSample& sample) {
      sample.stamp = kStart + (k / 10) * kSecond / 5;
      return (k / 10) * kSecond / 5 + kSecond / 5 + k % 10 * within;
    });
    EXPECT_NEAR(setup.imu_rate_hz.value_or(0.0), 50.0, 1.1) << within;
    EXPECT_TRUE(warns(setup, "/imu: no stamps, and record times come in batches of 10 samples"));
    EXPECT_FALSE(warns(setup, "times within a batch are not known"));
    EXPECT_FALSE(warns(setup, " Hz by its stamps"));
  }
}

TEST_F(AssumedInputs, SpikesOfAGyroAreNotDegreesPerSecond) {
  const auto setup = with_imu(500, [](int k, ImuSample& sample) {
    sample.angular_velocity = {k % 200 == 100 ? 300.0 : 0.01 * (k % 3), 0.0, 0.0};
    return k * kSecond / 50;
  });
  EXPECT_TRUE(warns(setup, "2 of the first 500 samples of the gyro are beyond 35 rad/s"));
  EXPECT_FALSE(warns(setup, "gyro_unit"));
}

TEST_F(AssumedInputs, AnAccelerometerInMilligravitiesIsNamedAndRead) {
  const auto milli = [](int k, ImuSample& sample) {
    sample.specific_force.z() = 1000.0;
    return k * kSecond / 50;
  };
  EXPECT_TRUE(warns(with_imu(200, milli), "set recording.imu_unit=mg"));
  RecordingConfig config;
  config.imu_unit = ImuUnit::kMilligravities;
  const Recording read = test::read_recording(bag(), config);
  EXPECT_TRUE(read.noted("IMU in mg (1000 at the start)"));
  EXPECT_TRUE(read.setup.warnings.empty());
}

TEST_F(AssumedInputs, FramesThatAreNoneOfASensorAreWarnings) {
  const auto setup_of = [this](const std::vector<FrameTransform>& frames, const std::string& topic,
                               const std::string& lidar) {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_transforms(frames, topic);
    robot.add_imu(kStart, 100);
    auto cloud = test::RawCloud::of(kStart, {{1.0F, 0.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F, 0.09F}});
    cloud.frame = lidar;
    robot.add_cloud(cloud, kStart + kSecond / 10);
    robot.close();
    return test::read_recording(bag(), {}).setup;
  };
  Pose in_mm;
  in_mm.translation.x() = 163.0;
  const auto far = setup_of({{"imu", "lidar", in_mm}}, "/tf_static", "lidar");
  EXPECT_TRUE(warns(far, "tf puts 'lidar' 163 m from 'imu'"));
  const auto moved = setup_of({{"imu", "camera_init", {}}}, "/tf_static", "camera_init");
  EXPECT_TRUE(warns(moved, "/points: its frame 'camera_init' is by its name one of the world"));
  const auto named = setup_of({{"imu", "lidar", {}}}, "/robot1/tf_static", "lidar");
  EXPECT_TRUE(std::ranges::count(named.notes, "/robot1/tf_static: taken for /tf_static") == 1);
  EXPECT_FALSE(warns(named, "NO TRANSFORM"));
}

TEST_F(AssumedInputs, ATruthOfPointsIsReadOnceItIsNamed) {
  const std::string base = odometry_type().definition;
  const MessageType points = {"geometry_msgs/PointStamped", "c63aecb41bfdfd6b7e1fac37c7cbe7bf",
                              "Header header\nPoint point\n" + base.substr(base.find("\n="))};
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 100);
  robot.add_clouds(kStart, 10);
  for (int k = 0; k < 20; ++k) {
    const Time now = kStart + k * kSecond / 10;
    MessageBytes bytes;
    bytes.put(std::uint32_t{7});
    bytes.time(now);
    bytes.text("world");
    for (const double value : {0.1 * k, 2.0, 3.0}) bytes.put(value);
    robot.add("/mocap/point", points, now, bytes);
  }
  robot.close();
  const Recording unnamed = test::read_recording(bag(), {});
  EXPECT_TRUE(unnamed.noted("--topics truth=/mocap/point"));
  RecordingConfig config;
  config.topics.truth = "/mocap/point";
  const Recording read = test::read_recording(bag(), config);
  ASSERT_EQ(read.truth.size(), 20U) << read.error;
  EXPECT_NEAR(read.truth[1].pose.translation.x(), 0.1, 1e-12);
}

TEST_F(AssumedInputs, TheOnlyOdometryIsNamedAndThatOfAnotherEstimatorIsAWarning) {
  const Recording usual = with_odometry("/odom");
  EXPECT_TRUE(usual.setup.has_legs);
  EXPECT_TRUE(usual.noted("leg odometry: /odom"));
  EXPECT_FALSE(warns(usual.setup, "estimate of another system"));
  EXPECT_TRUE(warns(with_odometry("/fast_lio/odometry").setup,
                    "/fast_lio/odometry is taken as leg odometry"));
  RecordingConfig chosen;
  chosen.topics.leg_odometry = "/fast_lio/odometry";
  EXPECT_FALSE(warns(with_odometry("/fast_lio/odometry", chosen).setup, "another system"));
}

TEST_F(AssumedInputs, FilesOfRecordersWhoseClocksDifferAreMergedByStamps) {
  for (const Duration ahead : {3 * kSecond / 2, 37 * kSecond, -3 * kSecond, 86'400 * kSecond}) {
    write_two_files(0, ahead, 0);
    auto reader = read_two_files();
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_TRUE(warns(reader->setup(), "by another recorder's clock")) << to_seconds(ahead);
    EXPECT_FALSE(warns(reader->setup(), "lidar_delay")) << to_seconds(ahead);
    const auto deliveries = test::read_all(*reader);
    ASSERT_TRUE(deliveries);
    EXPECT_EQ(test::scans_of(*deliveries).size(), 99U);
    Time last = 0;
    for (const Delivery& each : *deliveries) {
      EXPECT_GE(each.arrival, last);
      EXPECT_LT(std::abs(each.arrival - stamp_of(each.measurement)), kSecond / 4)
          << to_seconds(ahead) << ": at " << to_seconds(each.arrival);
      last = each.arrival;
    }
  }
}

TEST_F(AssumedInputs, ALidarWhoseOwnClockDiffersIsNoMatterOfTheRecorders) {
  for (const Duration late : {Duration{0}, 5 * kSecond, -5 * kSecond}) {
    for (const Duration ahead : {3 * kSecond / 2, -3 * kSecond / 2}) {
      write_two_files(late, 0, ahead);
      const auto reader = read_two_files();
      ASSERT_TRUE(reader) << reader.error().message;
      EXPECT_FALSE(warns(reader->setup(), "recorder's clock")) << to_seconds(late);
      EXPECT_TRUE(warns(reader->setup(), "set recording.lidar_delay=")) << to_seconds(late);
    }
  }
}

TEST_F(AssumedInputs, PartsOfOneRecordingStayOneBehindTheOther) {
  RobotRecording first(bag()), second(clouds());
  first.add_transforms(kMounted);
  first.add_imu(kStart, 500);
  first.add_clouds(kStart, 99);
  // Its computer was started again, and counts from boot as before.
  for (int k = 0; k < 500; ++k) {
    ImuSample sample;
    sample.stamp = kStart + k * 20 * kMillisecond;
    sample.specific_force.z() = 9.81;
    second.add("/imu", imu_type(), sample.stamp + 60 * kSecond,
               imu_message({0, sample.stamp, "imu"}, sample));
  }
  first.close();
  second.close();
  const auto reader = read_two_files();
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_FALSE(warns(reader->setup(), "recorder's clock"));
}

}  // namespace
}  // namespace aims
