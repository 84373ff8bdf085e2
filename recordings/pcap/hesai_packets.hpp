// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/error.hpp"
#include "core/measurements.hpp"
#include "recordings/pcap/revolutions.hpp"

namespace aims {

/// Whether a payload is a point packet of a Hesai sensor, by its first bytes (EE FF).
bool is_hesai_packet(std::span<const std::byte> payload);

/// Puts the scans of a Hesai XT32 or XT16 together from its point packets (protocol 6.1 of the
/// user manuals; firing times as in HesaiLidar_General_SDK): a scan ends where the azimuth passes
/// zero. Each point has the time of its firing, in the sensor's UTC. Of two returns the first block
/// is used. LiDAR axes as there: y at azimuth 0, x at 90 degrees, z up.
class HesaiScans {
 public:
  /// Adds a packet; returns the scan that it ends. The revolution that has begun before the first
  /// packet is left out, unless the packet begins one. Error for other models.
  Result<std::optional<LidarScan>> add(std::span<const std::byte> packet);

  /// The last scan, if it is complete.
  std::optional<LidarScan> finish() { return revolutions_.finish(); }

  /// Fraction of the turning without packets.
  double missing() const { return revolutions_.missing(); }

 private:
  struct Block {
    const std::byte* returns = nullptr;  ///< of its first channel
    int channels = 0;
    double unit = 0.0;     ///< of a distance [m]
    double azimuth = 0.0;  ///< [rad]
    double rate = 0.0;     ///< of the azimuth [rad/ns]
    Time stamp = 0;        ///< of the azimuth
  };
  void add_block(const Block& block);

  Revolutions revolutions_;
  int turn_ = 0;  ///< of the head over the last block [0.01 deg]
};

}  // namespace aims
