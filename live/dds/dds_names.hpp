// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace aims {

// Names that ROS 2 gives to topics and types in DDS: topic /imu/data is rt/imu/data, type
// sensor_msgs/Imu is sensor_msgs::msg::dds_::Imu_ (design.ros2.org, topic and service names).

/// "rt/imu/data" of "/imu/data".
std::string dds_topic(const std::string& topic);

/// "/imu/data" of "rt/imu/data"; nothing for what is no ROS topic, e.g. a service's.
std::optional<std::string> ros_topic(const std::string& dds);

/// "sensor_msgs::msg::dds_::Imu_" of "sensor_msgs/Imu".
std::string dds_type(const std::string& type);

/// "sensor_msgs/Imu" of "sensor_msgs::msg::dds_::Imu_"; nothing for what is no ROS message.
std::optional<std::string> ros_type(const std::string& dds);

}  // namespace aims
