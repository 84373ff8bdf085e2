// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/pcap/pcap_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <system_error>
#include <utility>

#include "recordings/messages/message_types.hpp"
#include "recordings/pcap/hesai_packets.hpp"
#include "recordings/pcap/ouster_packets.hpp"
#include "recordings/pcap/packet_decoder.hpp"
#include "recordings/pcap/packet_names.hpp"
#include "recordings/pcap/robosense_packets.hpp"
#include "recordings/pcap/udp_packets.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

}  // namespace

struct PcapReader::Impl {
  UdpPackets packets;
  std::optional<OusterMetadata> ouster;
  bool recover = false;
  enum class Maker { kVelodyne, kHesai, kRobosense } maker = Maker::kVelodyne;  ///< by its packets
  std::unique_ptr<PacketDecoder> decoder = {};
  Time time = 0;  ///< of the last packet; those of a capture may be out of order
  PacketMessage message = {};
  std::map<std::size_t, std::size_t> sizes = {};   ///< number of payloads by size [bytes]
  std::map<std::string, std::size_t> lidars = {};  ///< number of packets by who sends such

  UdpPackets::Cut cut = {};             ///< frames, when all is read
  std::string missing = {};             ///< of scans, when all is read
  std::optional<UdpSender> lidar = {};  ///< that all points are of
  std::vector<std::byte> points = {};   ///< the last packet of them

  void note_payload(std::span<const std::byte> payload);
  bool is_of_lidar(const UdpPacket& packet);
  void recognize(std::span<const std::byte> payload);
  std::unique_ptr<PacketDecoder> new_decoder() const;
  std::size_t packets_seen() const {
    std::size_t sum = 0;
    for (const auto& [size, count] : sizes) sum += count;
    return sum;
  }
  std::string found() const;
};

void PcapReader::Impl::note_payload(std::span<const std::byte> payload) {
  if (sizes.size() < 100) ++sizes[payload.size()];
  const std::string sender = lidar_of_packet(payload);
  if (!sender.empty()) ++lidars[sender];
}

/// Whether the packet is none of another LiDAR; one that is captured twice, on its way to a relay
/// and from there, is no other.
bool PcapReader::Impl::is_of_lidar(const UdpPacket& packet) {
  if (!decoder->has_points(packet.payload)) return true;
  const bool same = !lidar || *lidar == packet.sender;
  if (!same) return std::ranges::equal(packet.payload, points);
  lidar = packet.sender;
  points.assign(packet.payload.begin(), packet.payload.end());
  return true;
}

/// What refuses the packets of two LiDARs, and how to take those of one.
std::string two_lidars(const UdpSender& first, const UdpSender& second) {
  const std::string filter = first.address != second.address
                                 ? "src host " + address_text(first.address)
                                 : fmt::format("udp dst port {}", first.port);
  return fmt::format(
      "expected the packets of one LiDAR, found those of {} and of {}: `tcpdump -r IN -w OUT '{}'` "
      "keeps those of the first",
      text_of(first), text_of(second), filter);
}

/// Changes to the decoder of the first packet that tells whose it is.
void PcapReader::Impl::recognize(std::span<const std::byte> payload) {
  if (ouster || maker != Maker::kVelodyne) return;
  if (is_hesai_packet(payload)) maker = Maker::kHesai;
  if (is_robosense_packet(payload) || is_robosense_information(payload)) maker = Maker::kRobosense;
  if (maker != Maker::kVelodyne) decoder = new_decoder();
}

std::unique_ptr<PacketDecoder> PcapReader::Impl::new_decoder() const {
  if (ouster) return ouster_decoder(*ouster, true);
  if (maker == Maker::kHesai) return hesai_decoder("hesai_lidar");
  if (maker == Maker::kRobosense) return robosense_decoder("rslidar");
  return velodyne_decoder("velodyne");
}

/// What was found instead of scans.
std::string PcapReader::Impl::found() const {
  std::string text;
  for (const auto& [size, count] : sizes) {
    if (count * 20 < packets_seen()) continue;
    text += fmt::format("{}{} datagrams of {} bytes", text.empty() ? "" : ", ", count, size);
  }
  if (cut.frames > 0) {
    text += fmt::format(
        "{}{} packets that the capture cut, to {} of {} bytes (`tcpdump -s 0` "
        "keeps them whole)",
        text.empty() ? "" : ", ", cut.frames, cut.kept, cut.sent);
  }
  if (text.empty()) return "no UDP datagrams";
  for (const auto& [maker_name, count] : lidars) {
    if (count * 20 >= packets_seen()) text += fmt::format("; packets of {}", maker_name);
  }
  if (!missing.empty() && lidar) text += "; " + missing;
  return text;
}

PcapReader::PcapReader(std::unique_ptr<Impl> impl)
    : KindSource(std::to_array<KindSource::Kind>({{"/lidar/points", point_cloud_type()},
                                                  {"/imu/data", imu_type()},
                                                  {"/tf_static", transforms_type(), true}}),
                 impl->packets.file().size()),
      impl_(std::move(impl)) {}
PcapReader::PcapReader(PcapReader&&) noexcept = default;
PcapReader& PcapReader::operator=(PcapReader&&) noexcept = default;
PcapReader::~PcapReader() = default;

Result<PcapReader> PcapReader::open(const fs::path& file, BagOpenOptions options) {
  auto packets = UdpPackets::open(file);
  if (!packets) return tl::unexpected(packets.error());
  auto impl = std::unique_ptr<Impl>(new Impl{std::move(*packets), {}, options.recover});
  const fs::path metadata = fs::path(file).replace_extension(".json");
  std::error_code ignored;
  const bool ouster = fs::exists(metadata, ignored);
  if (ouster) {
    auto read = read_ouster_metadata(metadata);
    if (!read) return tl::unexpected(read.error());
    impl->ouster = std::move(*read);
  }
  PcapReader reader(std::move(impl));
  if (auto counted = reader.count(); !counted) return tl::unexpected(counted.error());
  if (std::ranges::find(reader.connections(), kScan, &BagConnection::id) !=
      reader.connections().end()) {
    return reader;
  }
  const std::string found = reader.impl_->found();
  return reader.impl_->packets.file().refuse(
      0, ouster ? fmt::format("expected complete scans of an Ouster, as the metadata beside it "
                              "describe ({} bytes a packet), found none: {}",
                              OusterScans(*reader.impl_->ouster).lidar_packet_size(), found)
                : fmt::format(
                      "expected complete scans of a Velodyne VLP-16, Puck Hi-Res, "
                      "HDL-32E or VLP-32C, a Hesai XT32 or XT16, or a RoboSense RS-LiDAR-16, found "
                      "none: {}; for an Ouster its metadata is expected beside it, as "
                      "NAME.json",
                      found));
}

std::string PcapReader::name() const { return impl_->packets.file().path().string(); }

Result<std::optional<KindSource::Made>> PcapReader::make() {
  Impl& pcap = *impl_;
  while (true) {
    const auto packet = pcap.packets.next();
    if (!packet && !pcap.recover) {
      if (pcap.packets_seen() == 0) return tl::unexpected(packet.error());
      return failure(packet.error().message + "; --recover reads the part before",
                     ErrorKind::kRecoverable);
    }
    if (!packet) set_incomplete(pcap.packets.file().size() - pcap.packets.position());
    if (!packet || !*packet) {
      auto last = pcap.decoder->finish();
      pcap.missing = pcap.decoder->missing();
      set_lost_packets(pcap.decoder->lost());
      pcap.cut = pcap.packets.cut();
      if (!last) return std::optional<Made>();
      pcap.message = std::move(*last);
      return Made{kScan, pcap.time, pcap.message.bytes.view(), pcap.packets.file().size()};
    }
    pcap.note_payload((*packet)->payload);
    const UdpPacket& each = **packet;
    pcap.recognize(each.payload);
    if (!pcap.is_of_lidar(each)) {
      return pcap.packets.file().refuse(each.position, two_lidars(*pcap.lidar, each.sender));
    }
    auto completed = pcap.decoder->add(each);
    if (!completed) return pcap.packets.file().refuse(each.position, completed.error().message);
    if (!*completed) continue;
    pcap.message = std::move(**completed);
    pcap.time = std::max(pcap.time, each.time);
    return Made{pcap.message.kind, pcap.time, pcap.message.bytes.view(), each.position};
  }
}

void PcapReader::rewind() {
  impl_->packets.rewind();
  impl_->time = 0;
  impl_->decoder = impl_->new_decoder();
}

}  // namespace aims
