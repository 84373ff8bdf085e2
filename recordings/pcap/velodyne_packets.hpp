// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/error.hpp"
#include "core/measurements.hpp"
#include "recordings/pcap/revolutions.hpp"
#include "recordings/pcap/velodyne_models.hpp"

namespace aims {

/// Bytes of a data packet of a Velodyne sensor.
inline constexpr std::size_t kVelodynePacketSize = 1206;

/// Whether these are the blocks of such a packet.
bool is_velodyne_packet(std::span<const std::byte> payload);

/// Puts the scans of a VLP-16, Puck Hi-Res, HDL-32E or VLP-32C together from its data packets
/// (their user manuals): a scan ends where the azimuth passes zero. Each point has the time of its
/// firing; its stamps are the microseconds of the packet in the hour that is nearest to the
/// capture. Of two returns the last one is used. LiDAR axes: x at azimuth 0, z up.
class VelodyneScans {
 public:
  /// Adds a packet that was captured at `capture`; returns the scan that it ends. The revolution
  /// that has begun before the first packet is left out. Error for
  /// other models, and for packets of two.
  Result<std::optional<LidarScan>> add(std::span<const std::byte> packet, Time capture);

  /// The last scan, if it is complete.
  std::optional<LidarScan> finish() { return revolutions_.finish(); }

  /// Fraction of the turning without packets.
  double missing() const { return revolutions_.missing(); }

 private:
  void set_model(const VelodyneModel& model);
  void add_block(const std::byte* block, double turn, Time stamp);

  const VelodyneModel* model_ = nullptr;  ///< by the first packet
  std::array<std::uint16_t, 32> rings_{};
  Revolutions revolutions_;
};

}  // namespace aims
