// SPDX-License-Identifier: BSD-3-Clause
// Assumptions about a recording that decide the result are warnings.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

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
  static bool warns(const RecordingSetup& setup, const std::string& part) {
    return std::ranges::any_of(setup.warnings, [&](const ReadingWarning& each) {
      return each.text.find(part) != std::string::npos;
    });
  }

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

}  // namespace
}  // namespace aims
