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

/// The payload of a UDP datagram, valid until the next one is read.
struct UdpPacket {
  Time time = 0;  ///< of the capture, of its last fragment
  std::span<const std::byte> payload;
  std::uint64_t position = 0;  ///< of the last frame in the file
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
  std::vector<std::byte> frame_;
  std::vector<std::byte> whole_;  ///< datagram of several fragments
  std::map<DatagramId, Fragments> open_;
};

}  // namespace aims
