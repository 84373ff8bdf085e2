// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "recordings/pcap/ouster_packets.hpp"
#include "recordings/pcap/udp_packets.hpp"

namespace aims {

/// What the packets of a LiDAR become.
enum PacketKind : std::size_t { kScan, kImu, kFrames };

/// A message that a packet completes.
struct PacketMessage {
  PacketKind kind = kScan;
  MessageBytes bytes = MessageBytes();
};

/// Turns the packets of one sensor into messages: scans as sensor_msgs/PointCloud2, and of an
/// Ouster its IMU as sensor_msgs/Imu and its frames as tf2_msgs/TFMessage.
class PacketDecoder {
 public:
  virtual ~PacketDecoder() = default;
  /// Nothing for packets that complete no message. Error for those of another model.
  virtual Result<std::optional<PacketMessage>> add(const UdpPacket& packet) = 0;
  /// The last scan, if it is complete.
  virtual std::optional<PacketMessage> finish() = 0;
  /// Whether the packet holds points.
  virtual bool has_points(std::span<const std::byte> payload) const = 0;
  /// What scans lack to be complete; empty where that is not known.
  virtual std::string missing() const { return ""; }
  /// Fraction of the packets of points that are missing in between [0 to 1].
  virtual double lost() const { return 0.0; }
};

/// Of a Velodyne VLP-16; `frame` is that of the clouds.
std::unique_ptr<PacketDecoder> velodyne_decoder(std::string frame);

/// Of a Hesai XT32 or XT16.
std::unique_ptr<PacketDecoder> hesai_decoder(std::string frame);

/// Of a RoboSense RS-LiDAR-16.
std::unique_ptr<PacketDecoder> robosense_decoder(std::string frame);

/// Of an Ouster; `with_frames`: the first message holds its frames.
std::unique_ptr<PacketDecoder> ouster_decoder(const OusterMetadata& metadata, bool with_frames);

/// The frames of an Ouster on /tf_static: os_sensor to os_lidar and to os_imu.
MessageBytes ouster_frames(const OusterMetadata& metadata, Time stamp);

}  // namespace aims
