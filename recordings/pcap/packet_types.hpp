// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace aims {

/// Whose packets a message holds.
enum class LidarMaker : std::uint8_t { kVelodyne, kHesai, kOuster, kRobosense };

/// How a message type holds packets.
struct PacketType {
  std::string_view type;
  LidarMaker maker = LidarMaker::kVelodyne;
  std::string_view packets;  ///< field of the array; empty: the message is one packet
  std::string_view data;
  std::string_view size;  ///< field of the used size of `data`; empty: all of it
};

/// Null for other types.
const PacketType* packet_type_of(std::string_view type);

/// A RoboSense has a topic of points, and one named like it with "difop" of information: the topic
/// of the points that a topic of information belongs to; itself, if it has points.
std::string topic_of_points(const std::string& topic);

}  // namespace aims
