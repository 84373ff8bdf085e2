// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/pcap/packet_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "core/files/byte_cursor.hpp"
#include "recordings/pcap/velodyne_models.hpp"

namespace aims {
namespace {

constexpr std::size_t kVelodyneSize = 1206, kVelodyneModelAt = 1205;
constexpr std::size_t kRobosenseSize = 1248, kRobosenseModelAt = 30;

int byte_or_none(std::span<const std::byte> bytes, std::size_t at) {
  return at < bytes.size() ? std::to_integer<int>(bytes[at]) : -1;
}

bool begins(std::span<const std::byte> payload, std::initializer_list<int> bytes) {
  std::size_t at = 0;
  return std::ranges::all_of(bytes, [&](int each) { return byte_or_none(payload, at++) == each; });
}

template <std::size_t kCount>
bool has_size(std::span<const std::byte> payload, const std::array<std::size_t, kCount>& sizes) {
  return std::ranges::find(sizes, payload.size()) != sizes.end();
}

// Of the profile LEGACY with 16, 32, 64 and 128 beams in 16 columns.
constexpr std::array<std::size_t, 4> kOuster = {3392, 6464, 12608, 24896};
// With and without their sequence number.
constexpr std::array<std::size_t, 2> kPandar40 = {1262, 1266}, kPandar64 = {1194, 1198};

bool is_livox(std::span<const std::byte> payload) {
  return payload.size() >= 36 && byte_or_none(payload, 0) == 0 &&
         load_number<std::uint16_t>(&payload[1]) == payload.size();
}

}  // namespace

std::string hesai_of_packet(std::span<const std::byte> payload) {
  if (has_size(payload, kPandar64) && byte_or_none(payload, 2) == 64) return "a Hesai Pandar64";
  const int protocol = byte_or_none(payload, 2), lasers = byte_or_none(payload, 6);
  const int blocks = byte_or_none(payload, 7);
  if (protocol == 1 && lasers == 128) return "a Hesai Pandar128";
  if (protocol == 3 && lasers == 64) return "a Hesai QT64";
  if (protocol == 3 && lasers == 128) return "a Hesai QT128";
  if (protocol == 4 && lasers == 128) return "a Hesai AT128";
  if (protocol == 6 && lasers == 32 && blocks == 6) return "a Hesai XT32M";
  if (protocol == 6 && lasers == 32 && blocks == 8) return "a Hesai XT32";
  if (protocol == 6 && lasers == 16 && blocks == 8) return "a Hesai XT16";
  return fmt::format("a Hesai of protocol {} with {} lasers in {} blocks", protocol, lasers,
                     blocks);
}

std::string robosense_of_model(int model) {
  constexpr std::array<std::string_view, 8> kNames = {
      "",           "an RS-LiDAR-16",  "an RS-LiDAR-32", "an RS-Bpearl",
      "an RS-Ruby", "an RS-Ruby Lite", "an RS-Helios",   "an RS-Helios-16P"};
  if (model > 0 && model < static_cast<int>(kNames.size())) {
    return fmt::format("{} (0x{:02x})", kNames[static_cast<std::size_t>(model)], model);
  }
  return fmt::format("a RoboSense of model 0x{:02x}", model);
}

std::string lidar_of_packet(std::span<const std::byte> payload) {
  if (payload.size() == kVelodyneSize && begins(payload, {0xff, 0xee})) {
    return velodyne_name(static_cast<std::uint8_t>(byte_or_none(payload, kVelodyneModelAt)));
  }
  if (begins(payload, {0xee, 0xff})) return hesai_of_packet(payload);
  if (has_size(payload, kPandar40) && begins(payload, {0xff, 0xee})) return "a Hesai Pandar40P";
  if (payload.size() == kRobosenseSize && begins(payload, {0x55, 0xaa, 0x05})) {
    return robosense_of_model(byte_or_none(payload, kRobosenseModelAt));
  }
  if (begins(payload, {0x55, 0xaa, 0x5a, 0xa5})) return "a RoboSense M1, M2 or E1";
  if (begins(payload, {0x55, 0xaa, 0x05})) return "a RoboSense of another model";
  if (has_size(payload, kOuster)) return "an Ouster";
  if (is_livox(payload)) return "a Livox HAP or Mid-360";
  return "";
}

}  // namespace aims
