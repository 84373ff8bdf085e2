// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/pcap/packet_decoder.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "recordings/pcap/hesai_packets.hpp"
#include "recordings/pcap/robosense_packets.hpp"
#include "recordings/pcap/velodyne_packets.hpp"

namespace aims {
namespace {

using Scan = Result<std::optional<LidarScan>>;

/// The scan that a packet ends; nothing for packets that are no points.
Scan scan_of(VelodyneScans& scans, const UdpPacket& packet) {
  if (packet.payload.size() != kVelodynePacketSize) return std::nullopt;
  return scans.add(packet.payload, packet.time);
}

Scan scan_of(HesaiScans& scans, const UdpPacket& packet) {
  if (!is_hesai_packet(packet.payload)) return std::nullopt;
  return scans.add(packet.payload);
}

Scan scan_of(RobosenseScans& scans, const UdpPacket& packet) {
  if (is_robosense_information(packet.payload)) scans.inform(packet.payload);
  if (!is_robosense_packet(packet.payload)) return std::nullopt;
  return scans.add(packet.payload);
}

std::optional<PacketMessage> cloud_of(const std::optional<LidarScan>& scan,
                                      const std::string& frame) {
  if (!scan) return std::nullopt;
  return PacketMessage{kScan, cloud_message({0, scan->stamp, frame}, *scan)};
}

/// Of a sensor whose packets become scans alone.
template <class Scans>
class ScanDecoder final : public PacketDecoder {
 public:
  explicit ScanDecoder(std::string frame) : frame_(std::move(frame)) {}

  Result<std::optional<PacketMessage>> add(const UdpPacket& packet) override {
    // A capture of any interface has packets twice.
    if (std::ranges::equal(packet.payload, last_)) return std::nullopt;
    last_.assign(packet.payload.begin(), packet.payload.end());
    const auto scan = scan_of(scans_, packet);
    if (!scan) return tl::unexpected(scan.error());
    return cloud_of(*scan, frame_);
  }

  std::optional<PacketMessage> finish() override { return cloud_of(scans_.finish(), frame_); }

 private:
  std::string frame_;
  Scans scans_;
  std::vector<std::byte> last_;  ///< packet
};

class OusterDecoder final : public PacketDecoder {
 public:
  OusterDecoder(const OusterMetadata& metadata, bool with_frames)
      : metadata_(metadata), scans_(metadata), framed_(!with_frames) {}

  Result<std::optional<PacketMessage>> add(const UdpPacket& packet) override {
    const bool imu = packet.payload.size() == OusterScans::kImuPacketSize;
    if (!imu && packet.payload.size() != scans_.lidar_packet_size()) return std::nullopt;
    if (!std::exchange(framed_, true)) {
      if (!imu) static_cast<void>(scans_.add(packet.payload));  // the first ends no scan
      return PacketMessage{kFrames, ouster_frames(metadata_, packet.time)};
    }
    if (imu) {
      const ImuSample sample = OusterScans::imu_of(packet.payload);
      return PacketMessage{kImu, imu_message({0, sample.stamp, "os_imu"}, sample)};
    }
    return cloud_of(scans_.add(packet.payload), "os_lidar");
  }

  std::optional<PacketMessage> finish() override {
    return cloud_of(scans_.finish(true), "os_lidar");
  }

 private:
  OusterMetadata metadata_;
  OusterScans scans_;
  bool framed_ = false;  ///< the frames are given
};

}  // namespace

std::unique_ptr<PacketDecoder> velodyne_decoder(std::string frame) {
  return std::make_unique<ScanDecoder<VelodyneScans>>(std::move(frame));
}

std::unique_ptr<PacketDecoder> hesai_decoder(std::string frame) {
  return std::make_unique<ScanDecoder<HesaiScans>>(std::move(frame));
}

std::unique_ptr<PacketDecoder> robosense_decoder(std::string frame) {
  return std::make_unique<ScanDecoder<RobosenseScans>>(std::move(frame));
}

std::unique_ptr<PacketDecoder> ouster_decoder(const OusterMetadata& metadata, bool with_frames) {
  return std::make_unique<OusterDecoder>(metadata, with_frames);
}

MessageBytes ouster_frames(const OusterMetadata& metadata, Time stamp) {
  return transforms_message(stamp, {{"os_sensor", "os_lidar", metadata.T_sensor_lidar},
                                    {"os_sensor", "os_imu", metadata.T_sensor_imu}});
}

}  // namespace aims
