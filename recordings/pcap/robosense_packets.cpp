// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/pcap/robosense_packets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/files/byte_cursor.hpp"
#include "recordings/pcap/packet_names.hpp"

namespace aims {
namespace {

constexpr std::size_t kDateAt = 20, kModelAt = 30, kBlocksAt = 42, kBlockSize = 100;
constexpr std::size_t kBlockHeader = 4, kReturn = 3;
constexpr int kBlocks = 12, kChannels = 16, kFullTurn = 36000;  ///< [0.01 deg]
constexpr std::size_t kModeInDifop = 300, kPitchInDifop = 1165;
constexpr std::uint8_t kRs16 = 0x01, kDualMode = 0x00;
constexpr std::uint16_t kFlag = 0xffee;
constexpr double kUnit = 0.005;            ///< of a distance [m]
constexpr double kCenter = 0.03825;        ///< of the lens from the axis [m]
constexpr double kFiringTime = 55'500.0;   ///< of the 16 channels [ns]
constexpr double kChannelTime = 2'800.0;   ///< from channel to channel [ns]
constexpr Duration kShortest = 1'000'000;  ///< packets closer than this hold two returns [ns]
constexpr int kBlindZone = 100;            ///< a turn of more passes over one [0.01 deg]
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kHundredth = kDegree / 100.0;

int byte_at(std::span<const std::byte> bytes, std::size_t at) {
  return std::to_integer<int>(bytes[at]);
}

std::uint16_t big(const std::byte* bytes) {
  return load_number<std::uint16_t>(bytes, std::endian::big);
}

/// The date of a packet; nothing for none.
std::optional<Time> date_of(std::span<const std::byte> packet) {
  using namespace std::chrono;
  const auto at = [&](std::size_t i) { return byte_at(packet, kDateAt + i); };
  // A sensor that was never set counts from month and day 0.
  const year_month_day date{year(2000 + at(0)), month(static_cast<unsigned>(std::max(1, at(1)))),
                            day(static_cast<unsigned>(std::max(1, at(2))))};
  if (!date.ok()) return std::nullopt;
  const auto since = sys_days(date) + hours(at(3)) + minutes(at(4)) + seconds(at(5));
  const int milliseconds = big(&packet[kDateAt + 6]), microseconds = big(&packet[kDateAt + 8]);
  return Time{since.time_since_epoch() / seconds(1)} * kSecond + milliseconds * kMillisecond +
         Time{microseconds} * 1000;
}

int azimuth_of(const std::byte* block) { return big(block + 2); }

}  // namespace

bool is_robosense_packet(std::span<const std::byte> payload) {
  return payload.size() == RobosenseScans::kPacketSize && byte_at(payload, 0) == 0x55 &&
         byte_at(payload, 1) == 0xaa && byte_at(payload, 2) == 0x05;
}

bool is_robosense_information(std::span<const std::byte> payload) {
  return payload.size() == RobosenseScans::kPacketSize && byte_at(payload, 0) == 0xa5 &&
         byte_at(payload, 1) == 0xff && byte_at(payload, 2) == 0x00 && byte_at(payload, 3) == 0x5a;
}

/// The nominal elevations: -15 to -1 and 15 to 1 degrees, every second one.
RobosenseScans::RobosenseScans() {
  for (int channel = 0; channel < kChannels; ++channel) {
    const int degrees = channel < 8 ? 2 * channel - 15 : 31 - 2 * channel;
    elevation_[static_cast<std::size_t>(channel)] = degrees * kDegree;
  }
}

void RobosenseScans::inform(std::span<const std::byte> packet) {
  informed_ = true;
  dual_ = byte_at(packet, kModeInDifop) == kDualMode;
  std::array<double, kChannels> found{};
  for (std::size_t channel = 0; channel < kChannels; ++channel) {
    const std::size_t at = kPitchInDifop + 3 * channel;
    const int value =
        (byte_at(packet, at) << 16) + (byte_at(packet, at + 1) << 8) + byte_at(packet, at + 2);
    const double degrees = 1e-4 * value;
    // A sensor without calibration has zeros or ones throughout.
    if (value == 0 || degrees > 45.0) return;
    found[channel] = (channel < 8 ? -degrees : degrees) * kDegree;
  }
  elevation_ = found;
}

double RobosenseScans::block_time() const { return dual_ ? kFiringTime : 2.0 * kFiringTime; }

void RobosenseScans::add_return(const Block& block, int channel, double after) {
  const std::byte* bytes = block.returns + static_cast<std::size_t>(channel) * kReturn;
  if (dual_) {
    const std::byte* other = bytes + kChannels * kReturn;
    const bool better = big(other) != 0 && (big(bytes) == 0 || other[2] > bytes[2]);
    if (better) bytes = other;
  }
  const double range = kUnit * big(bytes);
  if (range == 0.0) return;
  const int laser = channel % kChannels;
  const double azimuth = block.azimuth + block.turn * after / block_time();
  const double elevation = elevation_[static_cast<std::size_t>(laser)];
  const double across = range * std::cos(elevation) + kCenter;
  LidarPoint point;
  // The azimuth runs clockwise seen from above.
  point.position = Eigen::Vector3d(across * std::cos(azimuth), -across * std::sin(azimuth),
                                   range * std::sin(elevation))
                       .cast<float>();
  point.intensity = static_cast<float>(std::to_integer<int>(bytes[2])) / 255.0F;
  point.ring = static_cast<std::uint16_t>(laser < 8 ? laser : 23 - laser);
  const Time time = block.stamp + static_cast<Duration>(std::llround(after));
  revolutions_.add(point, time);
}

void RobosenseScans::add_block(const Block& block) {
  for (int channel = 0; channel < (dual_ ? 1 : 2) * kChannels; ++channel) {
    add_return(block, channel,
               channel / kChannels * kFiringTime + channel % kChannels * kChannelTime);
  }
}

std::optional<LidarScan> RobosenseScans::decode(std::span<const std::byte> packet, Time stamp) {
  std::optional<LidarScan> ended;
  double passed = 0.0;
  for (int i = 0; i < kBlocks; ++i) {
    const std::byte* block = &packet[kBlocksAt + static_cast<std::size_t>(i) * kBlockSize];
    const int azimuth = azimuth_of(block);
    if (big(block) != kFlag || azimuth >= kFullTurn) break;
    // The last block has none behind it in the packet: the head turns on as before.
    int turn = turn_;
    if (i + 1 < kBlocks) turn = (azimuth_of(block + kBlockSize) - azimuth + kFullTurn) % kFullTurn;
    if (turn > 0 && turn <= kBlindZone) turn_ = turn;
    if (auto scan = revolutions_.begin_block(azimuth, turn_)) ended = std::move(scan);
    if (revolutions_.is_wanted()) {
      add_block({block + kBlockHeader, azimuth * kHundredth, turn_ * kHundredth,
                 stamp + static_cast<Duration>(passed)});
    }
    // Over a blind zone, in which no block is sent, the head turns as before.
    passed +=
        block_time() * (turn > kBlindZone && turn_ > 0 ? turn / static_cast<double>(turn_) : 1.0);
  }
  return ended;
}

Result<std::optional<LidarScan>> RobosenseScans::add(std::span<const std::byte> packet) {
  const int model = byte_at(packet, kModelAt);
  if (byte_at(packet, 3) != 0x0a || model != kRs16) {
    return failure(fmt::format("packets of {}; read are those of an RS-LiDAR-16 (0x01)",
                               robosense_of_model(model)));
  }
  const auto stamp = date_of(packet);
  if (!stamp) return failure("expected a date in the packet of a RoboSense, found none");
  std::optional<LidarScan> ended;
  if (!held_.empty()) {
    const Duration between = *stamp - held_stamp_;
    if (!informed_ && between > 0 && between < kShortest) dual_ = true;
    ended = decode(held_, held_stamp_);
  }
  held_.assign(packet.begin(), packet.end());
  held_stamp_ = *stamp;
  return ended;
}

std::optional<LidarScan> RobosenseScans::finish() {
  const std::vector<std::byte> last = std::exchange(held_, {});
  // A scan that the last packet ends leaves less than that packet for the next.
  if (auto ended = last.empty() ? std::nullopt : decode(last, held_stamp_)) return ended;
  return revolutions_.finish();
}

}  // namespace aims
