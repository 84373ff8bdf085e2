// SPDX-License-Identifier: BSD-3-Clause
#include "live/dds/discovery.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

// The pairs that design.ros2.org and rmw_cyclonedds give.
TEST(DdsNames, AreThoseOfRos2) {
  EXPECT_EQ(dds_topic("/imu/data"), "rt/imu/data");
  EXPECT_EQ(dds_topic("chatter"), "rt/chatter");
  EXPECT_EQ(ros_topic("rt/utlidar/cloud"), "/utlidar/cloud");
  EXPECT_EQ(dds_type("sensor_msgs/PointCloud2"), "sensor_msgs::msg::dds_::PointCloud2_");
  EXPECT_EQ(ros_type("unitree_go::msg::dds_::LowState_"), "unitree_go/LowState");
}

TEST(DdsNames, OfServicesAndOtherSystemsAreNone) {
  EXPECT_FALSE(ros_topic("rq/set_parametersRequest"));
  EXPECT_FALSE(ros_topic("DCPSPublication"));
  EXPECT_FALSE(ros_topic("rt/"));
  EXPECT_FALSE(ros_type("example_interfaces::srv::dds_::AddTwoInts_Request_"));
  EXPECT_FALSE(ros_type("std_msgs::msg::dds_::_"));
  EXPECT_FALSE(ros_type("HelloWorld"));
}

}  // namespace
}  // namespace aims
