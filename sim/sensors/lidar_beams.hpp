// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/time.hpp"
#include "sim/environment/ray_caster.hpp"
#include "sim/sensors/lidar_calibration.hpp"
#include "sim/sensors/lidar_config.hpp"

namespace aims {

/// Nominal length of one scan.
Duration scan_period(const LidarConfig& config);

/// Time between the firings of neighbouring columns [ns].
double column_period_ns(const LidarConfig& config);

/// Time between the firings of neighbouring rings of a column [ns].
double ring_interval_ns(const LidarConfig& config);

/// Unit directions of sixteen beams in the LiDAR frame.
struct alignas(64) BeamDirections {
  RayPacket::Lanes x, y, z;
};

/// Sixteen neighbouring firings of one ring.
struct alignas(64) BeamPacket {
  BeamDirections nominal;                                   ///< as the sensor reports them
  std::array<std::int32_t, kRayPacketSize> time_offset_ns;  ///< after the scan's start
  std::array<bool, kRayPacketSize> open;  ///< not blocked, dead or in the body mask
};

/// The firings of a scan.
struct LidarBeams {
  std::vector<BeamPacket> packets;  ///< block of columns by block, ring by ring
  /// True directions, as `packets`; empty when they are the nominal ones.
  std::vector<BeamDirections> deviating;

  const BeamDirections& actual(int packet) const {
    const auto i = static_cast<std::size_t>(packet);
    return deviating.empty() ? packets[i].nominal : deviating[i];
  }
};

/// The beams of a run; dead rings are drawn from "lidar.defects".
LidarBeams make_beams(const LidarConfig& config, const LidarCalibration& calibration,
                      std::uint64_t run_seed);

}  // namespace aims
