// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/lidar.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace aims::independent {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

std::vector<double> even_table(int rings, double lowest, double spacing) {
  std::vector<double> table(static_cast<std::size_t>(rings));
  for (int ring = 0; double& each : table) each = lowest + spacing * ring++;
  return table;
}

std::vector<Eigen::Vector3d> directions_of(const LidarOptions& options) {
  std::vector<Eigen::Vector3d> directions;
  for (int column = 0; column < options.columns; ++column) {
    const double azimuth = std::numbers::pi * (1.0 - 2.0 * column / options.columns);
    for (const double elevation_deg : options.elevations_deg) {
      const double level = std::cos(elevation_deg * kRadians);
      directions.emplace_back(level * std::cos(azimuth), level * std::sin(azimuth),
                              std::sin(elevation_deg * kRadians));
    }
  }
  return directions;
}

}  // namespace

Result<std::vector<double>> ring_elevations_deg(std::string_view table) {
  if (table == "uneven") {
    return std::vector<double>{-22.0, -16.0, -11.5, -8.0, -5.5, -3.6, -2.1, -0.9,
                               0.3,   1.5,   2.9,   4.7,  7.2,  10.8, 15.6, 22.0};
  }
  if (table == "uniform") return even_table(16, -15.0, 2.0);
  if (table == "32") return even_table(32, -24.8, 1.6);
  return failure(fmt::format("unknown rings '{}'; expected uneven, uniform or 32", table));
}

SpinningLidar::SpinningLidar(const Pose& T_body_lidar, LidarOptions options)
    : T_body_lidar_(T_body_lidar),
      options_(std::move(options)),
      directions_(directions_of(options_)),
      noise_(rng(options_.seed, "independent.lidar.range")),
      outliers_(rng(options_.seed, "independent.lidar.outliers")) {}

/// 0: no return.
double SpinningLidar::measured(double distance) {
  if (distance < options_.min_range || distance > options_.max_range) return 0.0;
  if (outliers_.chance(options_.outliers)) return outliers_.uniform(options_.min_range, distance);
  return distance + options_.range_noise * noise_.normal();
}

LidarScan SpinningLidar::scan(const Walk& walk, const World& world, Time start) {
  LidarScan scan;
  scan.stamp = start;
  scan.end = start + kScanPeriod;
  scan.points.reserve(directions_.size());
  const Pose begin = walk.pose(to_seconds(start)) * T_body_lidar_;
  const World near = world.within(begin.translation, options_.max_range + 1.0);
  auto direction = directions_.begin();
  for (int column = 0; column < options_.columns; ++column) {
    const Duration offset = kScanPeriod * column / options_.columns;
    const Pose T_world_lidar = walk.pose(to_seconds(start + offset)) * T_body_lidar_;
    const Eigen::Matrix3d R_world_lidar = T_world_lidar.R();
    for (std::size_t ring = 0; ring < options_.elevations_deg.size(); ++ring, ++direction) {
      const double range =
          measured(near.distance(T_world_lidar.translation, R_world_lidar * *direction));
      if (range == 0.0) continue;
      scan.points.push_back({(range * *direction).cast<float>(), 0.5F,
                             static_cast<std::int32_t>(offset), static_cast<std::uint16_t>(ring)});
    }
  }
  return scan;
}

}  // namespace aims::independent
