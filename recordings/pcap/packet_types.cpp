// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/pcap/packet_types.hpp"

#include <algorithm>
#include <array>

namespace aims {
namespace {

constexpr auto kTypes = std::to_array<PacketType>({
    {"velodyne_msgs/VelodyneScan", LidarMaker::kVelodyne, "packets", "data", ""},
    {"pandar_msgs/PandarScan", LidarMaker::kHesai, "packets", "data", "size"},
    {"hesai_lidar/PandarScan", LidarMaker::kHesai, "packets", "data", "size"},
    {"hesai_ros_driver/UdpFrame", LidarMaker::kHesai, "packets", "data", "size"},
    {"rslidar_msgs/rslidarScan", LidarMaker::kRobosense, "packets", "data", ""},
    {"rslidar_msgs/rslidarPacket", LidarMaker::kRobosense, "", "data", ""},
    {"rslidar_msg/RslidarScan", LidarMaker::kRobosense, "packets", "data", ""},
    {"rslidar_msg/RslidarPacket", LidarMaker::kRobosense, "", "data", ""},
    {"ouster_ros/PacketMsg", LidarMaker::kOuster, "", "buf", ""},
    {"ouster_sensor_msgs/PacketMsg", LidarMaker::kOuster, "", "buf", ""},
});

}  // namespace

const PacketType* packet_type_of(std::string_view type) {
  const auto* const found = std::ranges::find(kTypes, type, &PacketType::type);
  return found == kTypes.end() ? nullptr : &*found;
}

std::string topic_of_points(const std::string& topic) {
  const std::size_t at = topic.find("difop");
  return at == std::string::npos || at == 0 ? topic : topic.substr(0, at - 1);
}

}  // namespace aims
