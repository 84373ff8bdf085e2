// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace aims {

/// One topic of one publisher.
struct RosConnection {
  std::string topic;       ///< resolved, e.g. "/imu/data"
  std::string type;        ///< e.g. "sensor_msgs/Imu"
  std::string md5;         ///< of the definition
  std::string definition;  ///< text of the message type and of all types that it uses
  bool latching = false;
};

/// A message from the network.
struct RosMessage {
  std::shared_ptr<const RosConnection> connection;
  std::int64_t arrival = 0;     ///< ROS time of arrival [ns]
  std::vector<std::byte> data;  ///< as serialized by ROS 1, little endian
};

}  // namespace aims
