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

/// Fills the lanes of a packet with the firings of a line from column `first` on; lanes beyond the
/// last column repeat it.
void fill(const LidarConfig& config, const LidarCalibration& calibration,
          const ScanPattern& pattern, std::int64_t scan, int first, int line, BeamPacket& beams,
          BeamDirections& actual) {
  const int last = pattern.columns(scan) - 1;
  for (int lane = 0; lane < kRayPacketSize; ++lane) {
    const Firing firing = pattern.firing(scan, std::min(first + lane, last), line);
    const Eigen::Vector3d direction = firing.beam.direction();
    beams.nominal.x[lane] = static_cast<float>(direction.x());
    beams.nominal.y[lane] = static_cast<float>(direction.y());
    beams.nominal.z[lane] = static_cast<float>(direction.z());
    beams.time_offset_ns[lane] = sensor_time_offset(firing.time_offset_ns);
    beams.open[lane] =
        !is_blocked(config.defects, direction) && !enters_body_mask(config, direction);
    if (calibration.directions_are_nominal()) continue;
    const Eigen::Vector3d fired = true_angles(calibration, line, firing.beam).direction();
    actual.x[lane] = static_cast<float>(fired.x());
    actual.y[lane] = static_cast<float>(fired.y());
    actual.z[lane] = static_cast<float>(fired.z());
  }
}

}  // namespace

std::vector<bool> working_lines(const LidarConfig& config, std::uint64_t run_seed) {
  RandomStream random = rng(run_seed, "lidar.defects");
  const int lines = line_count(config);
  std::vector<bool> works(static_cast<std::size_t>(lines), true);
  if (config.pattern == LidarPattern::kRosette) return works;
  // Drawn without replacement.
  const auto dead = std::lround(config.defects.dead_ring_fraction * lines);
  for (long lost = 0; lost < dead;) {
    const auto ring = static_cast<std::size_t>(random.uniform(0.0, lines));
    if (ring >= works.size() || !works[ring]) continue;
    works[ring] = false;
    ++lost;
  }
  return works;
}

LidarBeams make_beams(const LidarConfig& config, const ScanPattern& pattern,
                      const LidarCalibration& calibration, const std::vector<bool>& works,
                      std::int64_t scan) {
  const int columns = pattern.columns(scan);
  const auto packets =
      static_cast<std::size_t>((columns + kRayPacketSize - 1) / kRayPacketSize * pattern.lines());
  const bool nominal = calibration.directions_are_nominal();
  LidarBeams result;
  result.packets.reserve(packets);
  if (!nominal) result.deviating.reserve(packets);
  BeamDirections unused;
  for (int first = 0; first < columns; first += kRayPacketSize) {
    for (int line = 0; line < pattern.lines(); ++line) {
      BeamPacket& beams = result.packets.emplace_back();
      fill(config, calibration, pattern, scan, first, line, beams,
           nominal ? unused : result.deviating.emplace_back());
      if (!works[static_cast<std::size_t>(line)]) beams.open.fill(false);
    }
  }
  return result;
}

}  // namespace aims
