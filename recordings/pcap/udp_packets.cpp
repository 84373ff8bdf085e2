// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/pcap/udp_packets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "core/files/byte_cursor.hpp"

namespace aims {
namespace {

constexpr std::uint32_t kMicroseconds = 0xa1b2c3d4, kNanoseconds = 0xa1b23c4d;
constexpr std::uint32_t kNextGeneration = 0x0a0d0d0a;
constexpr std::size_t kFileHeader = 24, kFrameHeader = 16;
constexpr std::uint32_t kMaxFrame = 1 << 18;   ///< as libpcap's own limit [bytes]
constexpr std::size_t kMaxDatagram = 65535;    ///< of IPv4 [bytes]
constexpr std::size_t kMaxOpenDatagrams = 64;  ///< of which fragments are missing
constexpr std::uint32_t kNull = 0, kEthernet = 1, kRaw = 101, kCooked = 113, kCooked2 = 276;
constexpr std::uint16_t kIpv4 = 0x0800, kVlan = 0x8100, kProviderVlan = 0x88a8;
constexpr std::uint8_t kUdp = 17;

std::uint16_t big16(const std::byte* bytes) {
  return load_number<std::uint16_t>(bytes, std::endian::big);
}

/// The IPv4 packet in an Ethernet frame.
std::span<const std::byte> in_ethernet(std::span<const std::byte> frame) {
  std::size_t type = 12;
  while (frame.size() >= type + 2) {
    const std::uint16_t kind = big16(&frame[type]);
    if (kind == kIpv4) return frame.subspan(type + 2);
    if (kind != kVlan && kind != kProviderVlan) return {};
    type += 4;
  }
  return {};
}

std::span<const std::byte> ip_of(std::uint32_t link, std::span<const std::byte> frame) {
  const auto behind = [&](std::size_t size) {
    return frame.size() > size ? frame.subspan(size) : std::span<const std::byte>();
  };
  switch (link) {
    case kEthernet:
      return in_ethernet(frame);
    case kCooked:
      return behind(16);
    case kCooked2:
      return behind(20);
    case kNull:
      return behind(4);
    default:
      return frame;
  }
}

}  // namespace

std::string address_text(std::uint32_t address) {
  return fmt::format("{}.{}.{}.{}", address >> 24, address >> 16 & 0xff, address >> 8 & 0xff,
                     address & 0xff);
}

std::string text_of(const UdpSender& sender) {
  return fmt::format("{} to port {}", address_text(sender.address), sender.port);
}

std::uint32_t UdpPackets::number(const std::byte* bytes) const {
  return load_number<std::uint32_t>(bytes, swapped_ ? std::endian::big : std::endian::little);
}

Result<UdpPackets> UdpPackets::open(const std::filesystem::path& path) {
  auto file = BagFile::open(path);
  if (!file) return tl::unexpected(file.error());
  UdpPackets packets(std::move(*file));
  std::vector<std::byte> header(std::min<std::uint64_t>(packets.file_.size(), kFileHeader));
  if (auto got = packets.file_.read(0, header); !got) return tl::unexpected(got.error());
  if (header.size() < kFileHeader) return packets.file_.refuse(0, "expected a capture (.pcap)");
  std::uint32_t magic = packets.number(header.data());
  if (magic == kNextGeneration) {
    return packets.file_.refuse(0,
                                "expected a capture in the format of libpcap, found pcapng: "
                                "`editcap -F pcap IN OUT` converts it");
  }
  packets.swapped_ = magic != kMicroseconds && magic != kNanoseconds;
  magic = packets.number(header.data());
  if (magic != kMicroseconds && magic != kNanoseconds) {
    return packets.file_.refuse(0, "expected a capture (.pcap)");
  }
  packets.tick_ = magic == kMicroseconds ? kSecond / 1'000'000 : 1;
  packets.link_ = packets.number(&header[20]) & 0xffff;
  const auto links = {kNull, kEthernet, kRaw, kCooked, kCooked2};
  if (std::ranges::find(links, packets.link_) == links.end()) {
    return packets.file_.refuse(20, fmt::format("expected frames of Ethernet (1), IP (101), null "
                                                "(0) or Linux (113, 276), found link type {}",
                                                packets.link_));
  }
  packets.rewind();
  return packets;
}

void UdpPackets::rewind() {
  position_ = kFileHeader;
  open_.clear();
  cut_ = {};
}

Result<std::optional<UdpPacket>> UdpPackets::next() {
  while (position_ < file_.size()) {
    std::array<std::byte, kFrameHeader> header{};
    if (auto got = file_.read(position_, header); !got) return tl::unexpected(got.error());
    const std::uint32_t size = number(&header[8]);
    if (size > kMaxFrame) {
      return file_.refuse(position_, fmt::format("expected a frame of at most {} bytes, found {}",
                                                 kMaxFrame, size));
    }
    const std::uint32_t sent = number(&header[12]);
    if (sent > size && ++cut_.frames == 1) cut_ = {1, size, sent};
    frame_.resize(size);
    const std::uint64_t at = position_;
    if (auto got = file_.read(at + kFrameHeader, frame_); !got) return tl::unexpected(got.error());
    position_ = at + kFrameHeader + size;
    const auto payload = datagram(ip_of(link_, frame_));
    if (!payload) continue;
    const Time time = Time{number(header.data())} * kSecond + Time{number(&header[4])} * tick_;
    return UdpPacket{time, *payload, at, sender_};
  }
  return std::optional<UdpPacket>();
}

/// The payload of a UDP datagram in an IPv4 packet, if this completes it.
std::optional<std::span<const std::byte>> UdpPackets::datagram(std::span<const std::byte> ip) {
  if (ip.size() < 20 || std::to_integer<int>(ip[0]) >> 4 != 4) return std::nullopt;
  const std::size_t header = 4 * std::size_t(std::to_integer<int>(ip[0]) & 15);
  const std::size_t total = big16(&ip[2]);
  if (header < 20 || total < header || total > ip.size()) return std::nullopt;
  if (std::to_integer<std::uint8_t>(ip[9]) != kUdp) return std::nullopt;
  const std::uint16_t flags = big16(&ip[6]);
  const std::size_t offset = 8 * std::size_t(flags & 0x1fff);
  const bool more = (flags & 0x2000) != 0;
  std::optional<std::span<const std::byte>> udp = ip.subspan(header, total - header);
  if (more || offset > 0) {
    const DatagramId id = {load_number<std::uint64_t>(&ip[12]), big16(&ip[4])};
    udp = joined(id, offset, more, *udp);
  }
  if (!udp || udp->size() < 8) return std::nullopt;
  const std::size_t length = big16(&(*udp)[4]);
  if (length < 8 || length > udp->size()) return std::nullopt;
  sender_ = {load_number<std::uint32_t>(&ip[12], std::endian::big), big16(&(*udp)[2])};
  return udp->subspan(8, length - 8);
}

/// Adds a fragment; returns the datagram that it completes.
std::optional<std::span<const std::byte>> UdpPackets::joined(const DatagramId& id,
                                                             std::size_t offset, bool more,
                                                             std::span<const std::byte> part) {
  if (offset + part.size() > kMaxDatagram) return std::nullopt;
  if (open_.size() > kMaxOpenDatagrams) open_.clear();
  Fragments& fragments = open_[id];
  fragments.bytes.resize(std::max(fragments.bytes.size(), offset + part.size()));
  std::ranges::copy(part, fragments.bytes.begin() + static_cast<std::ptrdiff_t>(offset));
  fragments.received += part.size();
  if (!more) fragments.size = offset + part.size();
  if (fragments.size != fragments.received) return std::nullopt;
  whole_ = std::move(fragments.bytes);
  whole_.resize(*fragments.size);
  open_.erase(id);
  return whole_;
}

}  // namespace aims
