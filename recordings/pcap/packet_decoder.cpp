// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/pcap/packet_decoder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "recordings/pcap/hesai_packets.hpp"
#include "recordings/pcap/robosense_packets.hpp"
#include "recordings/pcap/velodyne_packets.hpp"

namespace aims {
namespace {

using Scan = Result<std::optional<LidarScan>>;

bool has_points_of(const VelodyneScans&, std::span<const std::byte> payload) {
  return is_velodyne_packet(payload);
}

bool has_points_of(const HesaiScans&, std::span<const std::byte> payload) {
  return is_hesai_packet(payload);
}

bool has_points_of(const RobosenseScans&, std::span<const std::byte> payload) {
  return is_robosense_packet(payload);
}

/// The scan that a packet of points ends.
Scan scan_of(VelodyneScans& scans, const UdpPacket& packet) {
  return scans.add(packet.payload, packet.time);
}

template <class Scans>
Scan scan_of(Scans& scans, const UdpPacket& packet) {
  return scans.add(packet.payload);
}

template <class Scans>
void inform(Scans&, std::span<const std::byte>) {}

void inform(RobosenseScans& scans, std::span<const std::byte> payload) {
  if (is_robosense_information(payload)) scans.inform(payload);
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
    inform(scans_, packet.payload);
    if (!has_points(packet.payload)) return std::nullopt;
    const auto scan = scan_of(scans_, packet);
    if (!scan) return tl::unexpected(scan.error());
    return cloud_of(*scan, frame_);
  }

  std::optional<PacketMessage> finish() override { return cloud_of(scans_.finish(), frame_); }

  bool has_points(std::span<const std::byte> payload) const override {
    return has_points_of(scans_, payload);
  }

  double lost() const override { return scans_.missing(); }

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
    if (!imu && !has_points(packet.payload)) return std::nullopt;
    std::vector<std::byte>& last = last_.at(imu ? 1 : 0);
    if (std::ranges::equal(packet.payload, last)) return std::nullopt;
    last.assign(packet.payload.begin(), packet.payload.end());
    if (!std::exchange(framed_, true)) {
      if (!imu) static_cast<void>(scans_.add(packet.payload));  // the first ends no scan
      return PacketMessage{kFrames, ouster_frames(metadata_, packet.time)};
    }
    if (imu) {
      const ImuSample sample = OusterScans::imu_of(packet.payload);
      return PacketMessage{kImu, imu_message({0, sample.stamp, "os_imu"}, sample)};
    }
    auto scan = scans_.add(packet.payload);
    if (const auto beyond = scans_.column_beyond()) {
      return failure(
          fmt::format("column {} in a packet of an Ouster, while its metadata have {} "
                      "columns (lidar_mode): are they of this recording",
                      *beyond, metadata_.columns_per_frame));
    }
    return cloud_of(scan, "os_lidar");
  }

  std::optional<PacketMessage> finish() override {
    return cloud_of(scans_.finish(true), "os_lidar");
  }

  bool has_points(std::span<const std::byte> payload) const override {
    return payload.size() == scans_.lidar_packet_size();
  }

  std::string missing() const override {
    return fmt::format("the fullest scan has {} of {} columns", scans_.most_columns(),
                       metadata_.window_columns);
  }

 private:
  OusterMetadata metadata_;
  OusterScans scans_;
  bool framed_ = false;                         ///< the frames are given
  std::array<std::vector<std::byte>, 2> last_;  ///< packets of the LiDAR and of the IMU
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
