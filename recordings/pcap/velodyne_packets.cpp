// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/pcap/velodyne_packets.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/files/byte_cursor.hpp"

namespace aims {
namespace {

constexpr int kBlocks = 12, kSequences = 2, kLasers = 16;
constexpr std::size_t kBlockSize = 100, kReturnSize = 3, kBlockHeader = 4;
constexpr std::size_t kStampOffset = kBlocks * kBlockSize, kModeOffset = kStampOffset + 4;
constexpr std::uint16_t kFlag = 0xeeff;
constexpr int kFullTurn = 36000;            ///< [0.01 deg]
constexpr double kUnit = 0.002;             ///< of a distance [m]
constexpr double kSequenceTime = 55'296.0;  ///< of the 16 lasers and their recharge [ns]
constexpr double kLaserTime = 2'304.0;      ///< between lasers [ns]
constexpr std::uint8_t kDual = 0x39, kVlp16 = 0x22;
constexpr Duration kHour = 3600 * kSecond;

/// Elevations [deg] and heights of the beams' origins [mm], by laser.
constexpr std::array<double, kLasers> kElevation = {-15, 1, -13, 3,  -11, 5,  -9, 7,
                                                    -7,  9, -5,  11, -3,  13, -1, 15};
constexpr std::array<double, kLasers> kHeight = {11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1,
                                                 5.1,  -6.6, 3.7, -8.1, 2.2, -9.7, 0.7, -11.2};

/// 0: lowest elevation.
std::uint16_t ring_of(int laser) {
  return static_cast<std::uint16_t>(laser % 2 == 0 ? laser / 2 : 8 + laser / 2);
}

int azimuth_of(const std::byte* block) { return load_number<std::uint16_t>(block + 2); }

/// The turn from one azimuth to a later one [0.01 deg].
int turn_between(int from, int to) { return (to - from + kFullTurn) % kFullTurn; }

/// In parentheses; empty for an unknown one (factory byte of the manuals).
std::string_view model_name(std::uint8_t model) {
  switch (model) {
    case 0x21:
      return " (an HDL-32E)";
    case 0x24:
      return " (a Puck Hi-Res)";
    case 0x28:
      return " (a VLP-32C)";
    case 0xa1:
      return " (a VLS-128)";
    default:
      return "";
  }
}

/// The time of a packet: its part of an hour, in the hour that lies nearest to the capture.
Time packet_time(std::uint32_t microseconds, Time capture) {
  const Time part = Time{microseconds} * 1000;
  const Time hours = (capture - part + kHour / 2) / kHour;
  return hours * kHour + part;
}

}  // namespace

/// `turn`: of the head over the block [rad].
void VelodyneScans::add_block(const std::byte* block, double turn, Time stamp) {
  constexpr double kBlockTime = kSequences * kSequenceTime;
  const double start = azimuth_of(block) * (2.0 * std::numbers::pi / kFullTurn);
  for (int firing = 0; firing < kSequences * kLasers; ++firing) {
    const std::byte* bytes = block + kBlockHeader + static_cast<std::size_t>(firing) * kReturnSize;
    const double range = kUnit * load_number<std::uint16_t>(bytes);
    if (range == 0.0) continue;
    const int laser = firing % kLasers;
    const double after = firing / kLasers * kSequenceTime + laser * kLaserTime;
    const double azimuth = start + turn * after / kBlockTime;
    const double elevation = kElevation[static_cast<std::size_t>(laser)] * std::numbers::pi / 180.0;
    const double across = range * std::cos(elevation);
    LidarPoint point;
    // The azimuth runs clockwise seen from above.
    point.position = Eigen::Vector3d(across * std::cos(azimuth), -across * std::sin(azimuth),
                                     range * std::sin(elevation) +
                                         1e-3 * kHeight[static_cast<std::size_t>(laser)])
                         .cast<float>();
    point.intensity = static_cast<float>(std::to_integer<int>(bytes[2])) / 255.0F;
    point.ring = ring_of(laser);
    const Time time = stamp + static_cast<Duration>(std::llround(after));
    revolutions_.add(point, time);
  }
}

Result<std::optional<LidarScan>> VelodyneScans::add(std::span<const std::byte> packet,
                                                    Time capture) {
  const auto model = std::to_integer<std::uint8_t>(packet[kModeOffset + 1]);
  if (model != kVlp16) {
    return failure(fmt::format("expected packets of a VLP-16 (0x22), found model 0x{:02x}{}", model,
                               model_name(model)));
  }
  const bool dual = std::to_integer<std::uint8_t>(packet[kModeOffset]) == kDual;
  const int step = dual ? 2 : 1;  // both returns of a firing have a block each
  const Time start = packet_time(load_number<std::uint32_t>(&packet[kStampOffset]), capture);
  std::optional<LidarScan> ended;
  int turn = 0;
  for (int i = 0; i < kBlocks; i += step) {
    const std::byte* block = &packet[static_cast<std::size_t>(i) * kBlockSize];
    if (load_number<std::uint16_t>(block) != kFlag) break;
    const int azimuth = azimuth_of(block);
    if (azimuth >= kFullTurn) break;
    // The last block has none behind it in the packet: the head turns on as before.
    if (i + step < kBlocks) turn = turn_between(azimuth, azimuth_of(block + kBlockSize * step));
    if (auto scan = revolutions_.begin_block(azimuth, turn)) ended = std::move(scan);
    const auto passed = static_cast<Duration>(i / step * kSequences * kSequenceTime);
    if (!revolutions_.is_whole()) continue;
    add_block(block, turn * (2.0 * std::numbers::pi / kFullTurn), start + passed);
  }
  return ended;
}

}  // namespace aims
