// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/pcap/hesai_packets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/files/byte_cursor.hpp"
#include "recordings/pcap/packet_names.hpp"

namespace aims {
namespace {

constexpr std::size_t kHeader = 12, kTail = 28, kReturn = 4, kBlockHeader = 2;
constexpr std::size_t kLasersAt = 6, kBlocksAt = 7, kUnitAt = 9;
constexpr std::size_t kModeInTail = 10, kDateInTail = 13, kTimeInTail = 19;
constexpr int kBlocks = 8, kFullTurn = 36000;  ///< [0.01 deg]
constexpr std::byte kProtocol{6};
constexpr std::uint8_t kFirstDualMode = 0x39, kLastDualMode = 0x3c;
constexpr double kFirstElevation = 15.0;  ///< of channel 1; the others follow downwards [deg]
constexpr double kBlockTime = 50'000.0;   ///< from firing to firing of a laser [ns]
constexpr double kLastBlock = 3'280.0;    ///< of the last block, after the packet's time [ns]
constexpr double kChannelTime = 1'512.0;  ///< from channel to channel [ns]
constexpr double kFirstChannel = 280.0;   ///< after the block's time [ns]

int byte_at(std::span<const std::byte> bytes, std::size_t at) {
  return std::to_integer<int>(bytes[at]);
}

/// The packet's UTC: a date to the second and microseconds; nothing for no date.
std::optional<Time> utc_of(std::span<const std::byte> tail) {
  using namespace std::chrono;
  const auto at = [&](std::size_t i) { return byte_at(tail, kDateInTail + i); };
  const year_month_day date{year(1900 + at(0)), month(static_cast<unsigned>(at(1))),
                            day(static_cast<unsigned>(at(2)))};
  if (!date.ok() || at(0) < 70) return std::nullopt;
  const auto since = sys_days(date) + hours(at(3)) + minutes(at(4)) + seconds(at(5));
  const auto part = load_number<std::uint32_t>(&tail[kTimeInTail]);
  return Time{since.time_since_epoch() / seconds(1)} * kSecond + Time{part} * 1000;
}

}  // namespace

bool is_hesai_packet(std::span<const std::byte> payload) {
  return payload.size() > kHeader + kTail && payload[0] == std::byte{0xee} &&
         payload[1] == std::byte{0xff};
}

void HesaiScans::add_block(const Block& block) {
  for (int channel = 0; channel < block.channels; ++channel) {
    const std::byte* bytes = block.returns + static_cast<std::size_t>(channel) * kReturn;
    const double range = block.unit * load_number<std::uint16_t>(bytes);
    if (range == 0.0) continue;
    // An XT16 has every second channel of an XT32.
    const int beam = block.channels == 16 ? 2 * channel : channel;
    const double after = kFirstChannel + beam * kChannelTime;
    const double azimuth = block.azimuth + block.rate * after;
    const double elevation = (kFirstElevation - beam) * std::numbers::pi / 180.0;
    const double across = range * std::cos(elevation);
    LidarPoint point;
    point.position = Eigen::Vector3d(across * std::sin(azimuth), across * std::cos(azimuth),
                                     range * std::sin(elevation))
                         .cast<float>();
    point.intensity = static_cast<float>(std::to_integer<int>(bytes[2])) / 255.0F;
    point.ring = static_cast<std::uint16_t>(block.channels - 1 - channel);
    const Time time = block.stamp + static_cast<Duration>(std::llround(after));
    revolutions_.add(point, time);
  }
}

Result<std::optional<LidarScan>> HesaiScans::add(std::span<const std::byte> packet) {
  const int lasers = byte_at(packet, kLasersAt), blocks = byte_at(packet, kBlocksAt);
  const std::size_t block_size = kBlockHeader + static_cast<std::size_t>(lasers) * kReturn;
  const std::size_t size = kHeader + static_cast<std::size_t>(blocks) * block_size + kTail;
  if (packet[2] != kProtocol || (lasers != 32 && lasers != 16) || blocks != kBlocks ||
      packet.size() != size) {
    return failure(
        fmt::format("packets of {} with {} bytes; read are those of a Hesai XT32 or XT16 (protocol "
                    "6, 32 or 16 lasers in 8 blocks)",
                    hesai_of_packet(packet), packet.size()));
  }
  const auto tail = packet.last(kTail);
  const auto mode = std::to_integer<std::uint8_t>(tail[kModeInTail]);
  const int step = mode >= kFirstDualMode && mode <= kLastDualMode ? 2 : 1;
  const auto utc = utc_of(tail);
  if (!utc) return failure("expected a date in the packet of a Hesai, found none");
  std::optional<LidarScan> ended;
  for (int i = 0; i < kBlocks; i += step) {
    const std::byte* block = &packet[kHeader + static_cast<std::size_t>(i) * block_size];
    const int azimuth = load_number<std::uint16_t>(block);
    if (azimuth >= kFullTurn) break;
    if (i + step < kBlocks) {
      const int next = load_number<std::uint16_t>(block + block_size * step);
      turn_ = (next - azimuth + kFullTurn) % kFullTurn;
    }
    if (auto scan = revolutions_.begin_block(azimuth, turn_)) ended = std::move(scan);
    const double before = (kBlocks - step - i) / step * kBlockTime;
    constexpr double kUnit = 2.0 * std::numbers::pi / kFullTurn;
    if (revolutions_.is_wanted()) {
      add_block({block + kBlockHeader, lasers, 1e-3 * byte_at(packet, kUnitAt), azimuth * kUnit,
                 turn_ * kUnit / kBlockTime, *utc + static_cast<Duration>(kLastBlock - before)});
    }
  }
  return ended;
}

}  // namespace aims
