// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.hpp"
#include "estimator/baselines/bievr/bump_map.hpp"

namespace aims::bievr::testing {

/// A wall along x whose face lies at y = 0.27 m + amplitude sin(2 pi x / wavelength); both in m.
struct WavyWall {
  double amplitude = 0.01;
  double wavelength = 0.4;

  double wave() const { return 2.0 * std::numbers::pi / wavelength; }
  double height(double x) const { return amplitude * std::sin(wave() * x); }
  double slope(double x) const { return amplitude * wave() * std::cos(wave() * x); }
  Eigen::Vector3d at(double x, double z) const { return {x, 0.27 + height(x), z}; }
};

/// Points of the wall on a grid of `spacing` [m], each `noise` [m] off its face.
inline std::vector<MapPoint> points_of(const WavyWall& wall, double length, double height,
                                       double spacing, double noise = 0.0) {
  RandomStream random(7, "wavy_wall");
  std::vector<MapPoint> points;
  for (double z = 0.5 * spacing; z < height; z += spacing) {
    for (double x = 0.5 * spacing; x < length; x += spacing) {
      points.push_back({wall.at(x, z) + noise * random.normal() * Eigen::Vector3d::UnitY(), 2.0});
    }
  }
  return points;
}

/// The map without smoothing.
inline MapConfig sharp() {
  MapConfig config;
  config.smooth = false;
  return config;
}

inline BumpMap map_of(const std::vector<MapPoint>& points, const MapConfig& config) {
  BumpMap map(config);
  map.insert(points);
  return map;
}

}  // namespace aims::bievr::testing
