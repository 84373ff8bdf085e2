// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "core/measurements.hpp"
#include "recordings/pcap/revolutions.hpp"

namespace aims {

/// Whether a payload is a packet of points of a RoboSense sensor, by its first bytes (55 AA 05).
bool is_robosense_packet(std::span<const std::byte> payload);

/// Whether a payload is its packet of device information (DIFOP: A5 FF 00 5A).
bool is_robosense_information(std::span<const std::byte> payload);

/// Puts the scans of an RS-LiDAR-16 together from its packets (MSOP and DIFOP, layout and firing
/// times as in rs_driver): a scan ends where the azimuth passes zero. Each point has the time of
/// its firing, by the sensor's date, which is taken as UTC. Elevations are those of its DIFOP
/// packets, before the first and without any the nominal ones. Of two returns the one with the
/// larger intensity is used. LiDAR axes as there: x at azimuth 0, y at 270 degrees, z up.
class RobosenseScans {
 public:
  RobosenseScans();

  /// Adds a packet of points; returns the scan that the packet before it ends, since the time
  /// between two packets tells whether a block holds one firing or two. The revolution that has
  /// begun before the first packet is left out, unless the packet begins one. Error for other
  /// models, and for a packet without a date.
  Result<std::optional<LidarScan>> add(std::span<const std::byte> packet);

  /// Adds a packet of device information.
  void inform(std::span<const std::byte> packet);

  /// The last scan, if it is complete.
  std::optional<LidarScan> finish();

  /// Fraction of the turning without packets.
  double missing() const { return revolutions_.missing(); }

  static constexpr std::size_t kPacketSize = 1248;

 private:
  struct Block {
    const std::byte* returns = nullptr;  ///< of its first channel
    double azimuth = 0.0;                ///< [rad]
    double turn = 0.0;                   ///< of the head over the block [rad]
    Time stamp = 0;
  };
  std::optional<LidarScan> decode(std::span<const std::byte> packet, Time stamp);
  void add_block(const Block& block);
  void add_return(const Block& block, int channel, double after);
  double block_time() const;

  std::array<double, 16> elevation_;  ///< by channel [rad]
  std::vector<std::byte> held_;       ///< the packet that waits for the next
  Time held_stamp_ = 0;
  bool dual_ = false;
  bool informed_ = false;  ///< DIFOP states whether there are two returns
  Revolutions revolutions_;
  int turn_ = 0;  ///< of the head over the last block [0.01 deg]
};

}  // namespace aims
