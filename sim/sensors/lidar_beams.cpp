// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/lidar_beams.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/angle.hpp"
#include "core/random.hpp"

namespace aims {
namespace {

/// Direction of a beam in the LiDAR frame.
struct BeamAngles {
  double azimuth = 0.0;    ///< from +x to +y [rad]
  double elevation = 0.0;  ///< [rad]

  Eigen::Vector3d direction() const {
    return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
            std::sin(elevation)};
  }
};

BeamAngles nominal_angles(const LidarConfig& config, int ring, double time_offset_ns) {
  const double turned = time_offset_ns / static_cast<double>(scan_period(config));
  const double fraction = config.rings > 1 ? static_cast<double>(ring) / (config.rings - 1) : 0.0;
  return {
      config.start_azimuth_deg * kRadiansPerDegree - 2.0 * std::numbers::pi * turned,
      kRadiansPerDegree * std::lerp(config.elevation_min_deg, config.elevation_max_deg, fraction)};
}

BeamAngles true_angles(const LidarCalibration& calibration, int ring, const BeamAngles& nominal) {
  return {nominal.azimuth + calibration.azimuth_cosine * std::cos(nominal.azimuth) +
              calibration.azimuth_sine * std::sin(nominal.azimuth),
          nominal.elevation + calibration.ring_elevation[static_cast<std::size_t>(ring)]};
}

/// Whether a beam from the origin enters the body mask.
bool enters_body_mask(const LidarConfig& config, const Eigen::Vector3d& direction) {
  if ((config.body_mask_max.array() <= config.body_mask_min.array()).any()) return false;
  double enter = 0.0;
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double low = config.body_mask_min[axis] / direction[axis];
    const double high = config.body_mask_max[axis] / direction[axis];
    enter = std::max(enter, std::min(low, high));
    leave = std::min(leave, std::max(low, high));
  }
  return enter <= leave;
}

/// The working rings: the dead ones are drawn without replacement.
std::vector<bool> working_rings(const LidarConfig& config, std::uint64_t run_seed) {
  RandomStream random = rng(run_seed, "lidar.defects");
  std::vector<bool> works(static_cast<std::size_t>(config.rings), true);
  const auto dead = std::lround(config.defects.dead_ring_fraction * config.rings);
  for (long lost = 0; lost < dead;) {
    const auto ring = static_cast<std::size_t>(random.uniform(0.0, config.rings));
    if (ring >= works.size() || !works[ring]) continue;
    works[ring] = false;
    ++lost;
  }
  return works;
}

/// The time offset of a firing [ns], rounded to float32 seconds as in a recording.
std::int32_t sensor_time_offset(double offset_ns) {
  const auto seconds = static_cast<float>(offset_ns * 1e-9);
  return static_cast<std::int32_t>(std::llround(static_cast<double>(seconds) * 1e9));
}

/// Whether a direction lies in the blocked sector.
bool is_blocked(const LidarDefectConfig& defects, const Eigen::Vector3d& direction) {
  const double azimuth = std::atan2(direction.y(), direction.x());
  const double off = azimuth - defects.blocked_sector_center_deg * kRadiansPerDegree;
  return std::abs(std::remainder(off, 2.0 * std::numbers::pi)) <
         0.5 * defects.blocked_sector_width_deg * kRadiansPerDegree;
}

/// Fills the lanes of a packet; lanes beyond the last column repeat it.
void fill(const LidarConfig& config, const LidarCalibration& calibration, int block, int ring,
          BeamPacket& beams, BeamDirections& actual) {
  for (int lane = 0; lane < kRayPacketSize; ++lane) {
    const int column = std::min(block * kRayPacketSize + lane, config.columns - 1);
    const double offset = column * column_period_ns(config) + ring * ring_interval_ns(config);
    const BeamAngles nominal = nominal_angles(config, ring, offset);
    const Eigen::Vector3d direction = nominal.direction();
    const Eigen::Vector3d fired = true_angles(calibration, ring, nominal).direction();
    beams.nominal.x[lane] = static_cast<float>(direction.x());
    beams.nominal.y[lane] = static_cast<float>(direction.y());
    beams.nominal.z[lane] = static_cast<float>(direction.z());
    beams.time_offset_ns[lane] = sensor_time_offset(offset);
    beams.open[lane] =
        !is_blocked(config.defects, direction) && !enters_body_mask(config, direction);
    actual.x[lane] = static_cast<float>(fired.x());
    actual.y[lane] = static_cast<float>(fired.y());
    actual.z[lane] = static_cast<float>(fired.z());
  }
}

}  // namespace

Duration scan_period(const LidarConfig& config) { return from_seconds(1.0 / config.rate); }

double column_period_ns(const LidarConfig& config) {
  return static_cast<double>(scan_period(config)) / config.columns;
}

double ring_interval_ns(const LidarConfig& config) {
  return std::min(1e3 * config.ring_interval_us, column_period_ns(config) / config.rings);
}

LidarBeams make_beams(const LidarConfig& config, const LidarCalibration& calibration,
                      std::uint64_t run_seed) {
  const std::vector<bool> works = working_rings(config, run_seed);
  const int blocks = (config.columns + kRayPacketSize - 1) / kRayPacketSize;
  LidarBeams result;
  for (int block = 0; block < blocks; ++block) {
    for (int ring = 0; ring < config.rings; ++ring) {
      BeamPacket& beams = result.packets.emplace_back();
      fill(config, calibration, block, ring, beams, result.deviating.emplace_back());
      if (!works[static_cast<std::size_t>(ring)]) beams.open.fill(false);
    }
  }
  if (calibration.directions_are_nominal()) result.deviating = {};
  return result;
}

}  // namespace aims
