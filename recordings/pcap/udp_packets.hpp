// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "core/error.hpp"
#include "core/time.hpp"
#include "recordings/bag/bag_file.hpp"

namespace aims {

/// Who sent a datagram, and to where.
struct UdpSender {
  std::uint32_t address = 0;  ///< of IPv4, of the sender
  std::uint16_t port = 0;     ///< of the receiver
  friend bool operator==(const UdpSender&, const UdpSender&) = default;
};

/// "192.168.1.201 to port 2368".
std::string text_of(const UdpSender& sender);

/// "192.168.1.201".
std::string address_text(std::uint32_t address);

/// The payload of a UDP datagram, valid until the next one is read.
struct UdpPacket {
  Time time = 0;  ///< of the capture, of its last fragment
  std::span<const std::byte> payload;
  std::uint64_t position = 0;  ///< of the last frame in the file
  UdpSender sender = {};
};

/// Reads the UDP datagrams of a capture in the format of libpcap (microseconds or nanoseconds,
/// either byte order): IPv4 over Ethernet, with VLAN tags, Linux "cooked" frames or none. Fragments
/// are put together. Everything else in the capture is skipped.
class UdpPackets {
 public:
  /// Error for other files, naming what they are, and for other links.
  static Result<UdpPackets> open(const std::filesystem::path& file);

  const BagFile& file() const { return file_; }

  /// The next datagram, or nothing at the end. Error for a truncated capture.
  Result<std::optional<UdpPacket>> next();
  void rewind();

  /// The frames that the capture cut, since the last rewind, and the first of them.
  struct Cut {
    std::size_t frames = 0;
    std::uint32_t kept = 0, sent = 0;  ///< of the first [bytes]
  };
  const Cut& cut() const { return cut_; }

  /// Where the next frame begins [bytes].
  std::uint64_t position() const { return position_; }

 private:
  /// What names the datagram of a fragment: addresses and identification.
  using DatagramId = std::tuple<std::uint64_t, std::uint16_t>;

  struct Fragments {
    std::vector<std::byte> bytes;
    std::size_t received = 0;
    std::optional<std::size_t> size;  ///< known from the last fragment
  };

  explicit UdpPackets(BagFile file) : file_(std::move(file)) {}
  std::uint32_t number(const std::byte* bytes) const;
  std::optional<std::span<const std::byte>> datagram(std::span<const std::byte> ip);
  std::optional<std::span<const std::byte>> joined(const DatagramId& id, std::size_t offset,
                                                   bool more, std::span<const std::byte> part);

  BagFile file_;
  bool swapped_ = false;
  Duration tick_ = 1;  ///< of the fraction of a second [ns]
  std::uint32_t link_ = 0;
  std::uint64_t position_ = 0;
  UdpSender sender_;  ///< of the last datagram
  Cut cut_;
  std::vector<std::byte> frame_;
  std::vector<std::byte> whole_;  ///< datagram of several fragments
  std::map<DatagramId, Fragments> open_;
};

}  // namespace aims
