// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/error.hpp"
#include "recordings/bag/message_source.hpp"

namespace aims {

/// Where a recording holds packets of LiDARs as messages, replaces `source` by one that also has
/// what they become, on topics below theirs: TOPIC/points, of an Ouster TOPIC/imu and its frames
/// on /tf_static. Types: velodyne_msgs/VelodyneScan; PandarScan of pandar_msgs and hesai_lidar and
/// hesai_ros_driver/UdpFrame; PacketMsg of ouster_ros and ouster_sensor_msgs, whose metadata is a
/// std_msgs/String on a topic that ends in "metadata", or NAME.json beside the recording. Rewinds.
/// Error for an Ouster without its metadata; `source` is then unchanged.
Result<void> decode_packets(std::unique_ptr<MessageSource>& source);

}  // namespace aims
