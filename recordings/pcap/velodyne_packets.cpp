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

constexpr int kBlocks = 12;
constexpr std::size_t kBlockSize = 100, kReturns = 32, kReturnSize = 3, kBlockHeader = 4;
constexpr std::size_t kStampOffset = kBlocks * kBlockSize, kModeOffset = kStampOffset + 4;
constexpr std::uint16_t kFlag = 0xeeff;
constexpr int kFullTurn = 36000;  ///< [0.01 deg]
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::uint8_t kDual = 0x39;
constexpr Duration kHour = 3600 * kSecond;

/// The number of lasers below this one.
std::uint16_t ring_of(const VelodyneModel& model, std::size_t laser) {
  std::uint16_t below = 0;
  for (std::size_t i = 0; i < model.lasers; ++i) {
    if (model.elevation[i] < model.elevation[laser]) ++below;
  }
  return below;
}

int azimuth_of(const std::byte* block) { return load_number<std::uint16_t>(block + 2); }

/// The turn from one azimuth to a later one [0.01 deg].
int turn_between(int from, int to) { return (to - from + kFullTurn) % kFullTurn; }

/// The time of a packet: its part of an hour, in the hour that lies nearest to the capture.
Time packet_time(std::uint32_t microseconds, Time capture) {
  const Time part = Time{microseconds} * 1000;
  const Time hours = (capture - part + kHour / 2) / kHour;
  return hours * kHour + part;
}

}  // namespace

bool is_velodyne_packet(std::span<const std::byte> payload) {
  return payload.size() == kVelodynePacketSize &&
         load_number<std::uint16_t>(payload.data()) == kFlag;
}

void VelodyneScans::set_model(const VelodyneModel& model) {
  model_ = &model;
  for (std::size_t laser = 0; laser < model.lasers; ++laser) rings_[laser] = ring_of(model, laser);
}

/// `turn`: of the head over the block [rad].
void VelodyneScans::add_block(const std::byte* block, double turn, Time stamp) {
  const VelodyneModel& model = *model_;
  const double start = azimuth_of(block) * (2.0 * std::numbers::pi / kFullTurn);
  for (std::size_t firing = 0; firing < kReturns; ++firing) {
    const std::byte* bytes = block + kBlockHeader + firing * kReturnSize;
    const double range = model.unit * load_number<std::uint16_t>(bytes);
    if (range == 0.0) continue;
    const std::size_t laser = firing % model.lasers;
    const double after = static_cast<double>(firing / model.lasers) * model.sequence_time +
                         static_cast<double>(laser / model.at_once) * model.laser_time;
    const double azimuth =
        start + turn * after / model.block_time() + model.azimuth[laser] * kDegree;
    const double elevation = model.elevation[laser] * kDegree;
    const double across = range * std::cos(elevation);
    LidarPoint point;
    // The azimuth runs clockwise seen from above.
    point.position = Eigen::Vector3d(across * std::cos(azimuth), -across * std::sin(azimuth),
                                     range * std::sin(elevation) + 1e-3 * model.height[laser])
                         .cast<float>();
    point.intensity = static_cast<float>(std::to_integer<int>(bytes[2])) / 255.0F;
    point.ring = rings_[laser];
    const Time time = stamp + static_cast<Duration>(std::llround(after));
    revolutions_.add(point, time);
  }
}

Result<std::optional<LidarScan>> VelodyneScans::add(std::span<const std::byte> packet,
                                                    Time capture) {
  const auto code = std::to_integer<std::uint8_t>(packet[kModeOffset + 1]);
  const VelodyneModel* model = velodyne_model(code);
  if (model == nullptr || (model_ != nullptr && model != model_)) {
    return failure(fmt::format(
        "packets of {}; read are those of one {}", velodyne_name(code),
        model_ != nullptr ? std::string(model_->name) : "VLP-16, Puck Hi-Res, HDL-32E or VLP-32C"));
  }
  if (model_ == nullptr) set_model(*model);
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
    const auto passed = static_cast<Duration>(i / step * model->block_time());
    if (!revolutions_.is_wanted()) continue;
    add_block(block, turn * (2.0 * std::numbers::pi / kFullTurn), start + passed);
  }
  return ended;
}

}  // namespace aims
