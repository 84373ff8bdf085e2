// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace aims {

/// A ROS 1 message type.
struct MessageType {
  std::string name;        ///< e.g. "sensor_msgs/Imu"
  std::string md5;         ///< 32 hex digits that identify the version of the type
  std::string definition;  ///< text of its fields, then of every type that it uses
};

}  // namespace aims
