// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/lie.hpp"
#include "core/measurements.hpp"
#include "core/random.hpp"
#include "tests/support/kinematic_world.hpp"

namespace aims::testing {

/// A room without doors, seen from its middle; much longer than wide with open ends: a corridor.
inline test::CorridorShape room(double length, double width, double height) {
  test::CorridorShape shape;
  shape.begin = -length / 2.0;
  shape.end = length / 2.0;
  shape.width = width;
  shape.height = height;
  shape.door_spacing = 0.0;
  return shape;
}

inline test::CorridorShape open_corridor() {
  test::CorridorShape shape = room(400.0, 2.2, 2.6);
  shape.open_ends = true;
  return shape;
}

struct ScanOptions {
  int columns = 1800;
  double noise = 0.0;  ///< of each range [m]
  std::uint64_t seed = 1;
};

/// A LiDAR of 16 rings that turns once while it moves from `T_world_start` by the motion
/// `T_start_end`: translation and rotation grow evenly. Nothing is seen beyond 60 m.
inline LidarScan scan_in(const test::CorridorShape& shape, const Pose& T_world_start,
                         const Pose& T_start_end = Pose(), const ScanOptions& options = {}) {
  RandomStream random(options.seed, "room_scan");
  LidarScan scan;
  scan.end = 100 * kMillisecond;
  for (int column = 0; column < options.columns; ++column) {
    const double fraction = static_cast<double>(column) / options.columns;
    const Pose T_world_lidar = T_world_start * interpolate(Pose(), T_start_end, fraction);
    const double azimuth = -2.0 * std::numbers::pi * fraction;
    for (int ring = 0; ring < 16; ++ring) {
      const double elevation = (2.0 * ring - 15.0) * std::numbers::pi / 180.0;
      const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                      std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const double noise = options.noise * random.normal();
      const double range = noise + test::cast_ray(shape, T_world_lidar.translation,
                                                  T_world_lidar.rotation * direction)
                                       .distance;
      if (range <= 0.1 || range > 60.0) continue;
      const auto offset = static_cast<std::int32_t>(fraction * static_cast<double>(scan.end));
      scan.points.push_back(
          {(range * direction).cast<float>(), 0.5F, offset, static_cast<std::uint16_t>(ring)});
    }
  }
  return scan;
}

/// A pose from its parts: position [m] and rotation vector [rad].
inline Pose pose_of(const Eigen::Vector3d& position, const Eigen::Vector3d& rotation) {
  return {so3_exp(rotation), position};
}

/// Distance between the positions [m] and angle between the rotations [rad] of two poses.
inline double position_error(const Pose& a, const Pose& b) {
  return (a.translation - b.translation).norm();
}
inline double rotation_error(const Pose& a, const Pose& b) {
  return so3_log(a.rotation.conjugate() * b.rotation).norm();
}

}  // namespace aims::testing
