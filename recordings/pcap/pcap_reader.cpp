// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/pcap/pcap_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"
#include "recordings/pcap/ouster_packets.hpp"
#include "recordings/pcap/udp_packets.hpp"
#include "recordings/pcap/velodyne_packets.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

enum Kind : std::size_t { kScan, kImu, kFrames, kKinds };
constexpr std::array<const char*, kKinds> kTopics = {"/lidar/points", "/imu/data", "/tf_static"};

/// A message that a packet completes.
struct PacketMessage {
  Kind kind = kScan;
  MessageBytes bytes = MessageBytes();
};

/// Turns the packets of one sensor into messages.
class PacketDecoder {
 public:
  virtual ~PacketDecoder() = default;
  /// Nothing for packets that complete no message. Error for those of another model.
  virtual Result<std::optional<PacketMessage>> add(const UdpPacket& packet) = 0;
};

class VelodyneDecoder final : public PacketDecoder {
 public:
  Result<std::optional<PacketMessage>> add(const UdpPacket& packet) override {
    if (packet.payload.size() != kVelodynePacketSize) return std::nullopt;
    const auto scan = scans_.add(packet.payload, packet.time);
    if (!scan) return tl::unexpected(scan.error());
    if (!*scan) return std::nullopt;
    return PacketMessage{kScan, cloud_message({0, (*scan)->stamp, "velodyne"}, **scan)};
  }

 private:
  VelodyneScans scans_;
};

class OusterDecoder final : public PacketDecoder {
 public:
  explicit OusterDecoder(const OusterMetadata& metadata) : metadata_(metadata), scans_(metadata) {}

  Result<std::optional<PacketMessage>> add(const UdpPacket& packet) override {
    const bool imu = packet.payload.size() == OusterScans::kImuPacketSize;
    if (!imu && packet.payload.size() != scans_.lidar_packet_size()) return std::nullopt;
    if (!std::exchange(framed_, true)) return PacketMessage{kFrames, frames(packet.time)};
    if (imu) {
      const ImuSample sample = OusterScans::imu_of(packet.payload);
      return PacketMessage{kImu, imu_message({0, sample.stamp, "os_imu"}, sample)};
    }
    const auto scan = scans_.add(packet.payload);
    if (!scan) return std::nullopt;
    return PacketMessage{kScan, cloud_message({0, scan->stamp, "os_lidar"}, *scan)};
  }

 private:
  MessageBytes frames(Time stamp) const {
    return transforms_message(stamp, {{"os_sensor", "os_lidar", metadata_.T_sensor_lidar},
                                      {"os_sensor", "os_imu", metadata_.T_sensor_imu}});
  }

  OusterMetadata metadata_;
  OusterScans scans_;
  bool framed_ = false;  ///< the frames are given
};

}  // namespace

struct PcapReader::Impl {
  UdpPackets packets;
  std::optional<OusterMetadata> ouster;
  bool recover = false;
  std::unique_ptr<PacketDecoder> decoder = {};
  std::vector<BagConnection> connections = {};
  BagSummary summary = {};
  Time time = 0;  ///< of the last packet; those of a capture may be out of order
  std::array<bool, kKinds> chosen = {};
  PacketMessage message = {};

  void rewind();
  /// The next message of any kind, and the packet that completes it.
  Result<std::optional<UdpPacket>> advance();
  Result<void> count();
};

void PcapReader::Impl::rewind() {
  packets.rewind();
  time = 0;
  if (ouster) {
    decoder = std::make_unique<OusterDecoder>(*ouster);
  } else {
    decoder = std::make_unique<VelodyneDecoder>();
  }
}

Result<std::optional<UdpPacket>> PcapReader::Impl::advance() {
  while (true) {
    const auto packet = packets.next();
    if (!packet && recover) {
      summary.indexed = false;
      return std::optional<UdpPacket>();
    }
    if (!packet) {
      return failure(packet.error().message + "; --recover reads the part before");
    }
    if (!*packet) return std::optional<UdpPacket>();
    auto completed = decoder->add(**packet);
    if (!completed) return packets.file().refuse((*packet)->position, completed.error().message);
    if (!*completed) continue;
    message = std::move(**completed);
    time = std::max(time, (*packet)->time);
    UdpPacket last = **packet;
    last.time = time;
    return last;
  }
}

/// Lists the topics, with the number of messages of each.
Result<void> PcapReader::Impl::count() {
  const std::array<MessageType, kKinds> types = {point_cloud_type(), imu_type(), transforms_type()};
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    BagConnection connection;
    connection.id = static_cast<std::uint32_t>(kind);
    connection.topic = kTopics[kind];
    connection.type = types[kind].name;
    connection.md5 = types[kind].md5;
    connection.definition = types[kind].definition;
    connection.latching = kind == kFrames;
    connections.push_back(std::move(connection));
  }
  while (true) {
    const auto packet = advance();
    if (!packet) return tl::unexpected(packet.error());
    if (!*packet) break;
    if (summary.messages == 0) summary.start = time;
    summary.end = time;
    ++summary.messages;
    ++connections[message.kind].messages;
  }
  if (connections[kScan].messages == 0) {
    return packets.file().refuse(
        0, ouster ? "expected whole scans of an Ouster, as the metadata beside it describe, found "
                    "none"
                  : "expected whole scans of a Velodyne VLP-16, found none; for an Ouster its "
                    "metadata is expected beside it, as NAME.json");
  }
  return {};
}

PcapReader::PcapReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PcapReader::PcapReader(PcapReader&&) noexcept = default;
PcapReader& PcapReader::operator=(PcapReader&&) noexcept = default;
PcapReader::~PcapReader() = default;

Result<PcapReader> PcapReader::open(const fs::path& file, BagOpenOptions options) {
  auto packets = UdpPackets::open(file);
  if (!packets) return tl::unexpected(packets.error());
  auto impl = std::unique_ptr<Impl>(new Impl{std::move(*packets), {}, options.recover});
  const fs::path metadata = fs::path(file).replace_extension(".json");
  std::error_code ignored;
  if (fs::exists(metadata, ignored)) {
    auto read = read_ouster_metadata(metadata);
    if (!read) return tl::unexpected(read.error());
    impl->ouster = std::move(*read);
  }
  impl->summary.file_size = impl->packets.file().size();
  impl->summary.chunks = 1;
  impl->summary.compression = name_of(BagCompression::kNone);
  impl->rewind();
  if (auto counted = impl->count(); !counted) return tl::unexpected(counted.error());
  impl->chosen.fill(true);
  impl->rewind();
  return PcapReader(std::move(impl));
}

std::string PcapReader::name() const { return impl_->packets.file().path().string(); }

const std::vector<BagConnection>& PcapReader::connections() const { return impl_->connections; }

const BagSummary& PcapReader::summary() const { return impl_->summary; }

void PcapReader::select(std::span<const std::string> topics) {
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    impl_->chosen[kind] = std::ranges::find(topics, kTopics[kind]) != topics.end();
  }
}

Result<std::optional<BagMessage>> PcapReader::next() {
  Impl& pcap = *impl_;
  while (true) {
    const auto packet = pcap.advance();
    if (!packet) return tl::unexpected(packet.error());
    if (!*packet) return std::optional<BagMessage>();
    if (!pcap.chosen[pcap.message.kind]) continue;
    return BagMessage{&pcap.connections[pcap.message.kind], (*packet)->time,
                      pcap.message.bytes.view(), (*packet)->position};
  }
}

void PcapReader::rewind() { impl_->rewind(); }

}  // namespace aims
