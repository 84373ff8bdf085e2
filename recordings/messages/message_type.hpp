// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace aims {

/// A ROS 1 message type, as a bag announces it.
struct MessageType {
  std::string name;        ///< e.g. "sensor_msgs/Imu"
  std::string md5;         ///< 32 hex digits, by which ROS tells versions of a type apart
  std::string definition;  ///< its fields, then those of every type that it uses
};

}  // namespace aims
