// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace aims {

/// One topic of one publisher.
struct LiveConnection {
  std::string topic;       ///< resolved, e.g. "/imu/data"
  std::string type;        ///< e.g. "sensor_msgs/Imu", in ROS 2 too
  std::string md5;         ///< of the definition; ROS 1 alone
  std::string definition;  ///< of the message type and of all that it uses; ROS 1 alone
  bool latching = false;   ///< late subscribers receive the last message
  bool cdr = false;        ///< messages as ROS 2 serializes them; else as ROS 1 does
};

/// This computer's time [ns] since the epoch.
inline std::int64_t wall_time() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

/// A message from the network.
struct LiveMessage {
  std::shared_ptr<const LiveConnection> connection;
  std::int64_t arrival = 0;     ///< [ns] since the epoch
  std::vector<std::byte> data;  ///< ROS 1: little endian; ROS 2: CDR behind its header
};

}  // namespace aims
