// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/environment/ray_caster.hpp"
#include "sim/sensors/lidar_calibration.hpp"
#include "sim/sensors/lidar_config.hpp"
#include "sim/sensors/scan_pattern.hpp"

namespace aims {

/// Unit directions of sixteen beams in the LiDAR frame.
struct alignas(64) BeamDirections {
  RayPacket::Lanes x, y, z;
};

/// Sixteen neighbouring firings of one ring or line.
struct alignas(64) BeamPacket {
  BeamDirections nominal;                                   ///< as the sensor reports them
  std::array<std::int32_t, kRayPacketSize> time_offset_ns;  ///< after the scan's start
  std::array<bool, kRayPacketSize> open;  ///< not blocked, dead or in the body mask
};

/// The firings of a scan.
struct LidarBeams {
  std::vector<BeamPacket> packets;  ///< block of columns by block, line by line
  /// True directions, as `packets`; empty when they are the nominal ones.
  std::vector<BeamDirections> deviating;

  const BeamDirections& actual(int packet) const {
    const auto i = static_cast<std::size_t>(packet);
    return deviating.empty() ? packets[i].nominal : deviating[i];
  }
};

/// The rings or lines that work; the dead rings of a run are drawn from "lidar.defects".
std::vector<bool> working_lines(const LidarConfig& config, std::uint64_t run_seed);

/// The beams of scan `scan`.
LidarBeams make_beams(const LidarConfig& config, const ScanPattern& pattern,
                      const LidarCalibration& calibration, const std::vector<bool>& works,
                      std::int64_t scan);

}  // namespace aims
