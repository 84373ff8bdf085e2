// SPDX-License-Identifier: BSD-3-Clause
#include "tests/estimator/degeneracy/synthetic_corridor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aims::test {
namespace {

constexpr int kColumns = 450;

/// Distance along `direction` to the face; infinite when the ray misses it.
double distance_to(const Face& face, const Eigen::Vector3d& origin,
                   const Eigen::Vector3d& direction) {
  constexpr double kMiss = std::numeric_limits<double>::infinity();
  const double t = (face.low(face.axis) - origin(face.axis)) / direction(face.axis);
  if (!(t > 0.0)) return kMiss;
  for (int other = 1; other < 3; ++other) {
    const int i = (face.axis + other) % 3;
    const double at = origin(i) + t * direction(i);
    if (at < face.low(i) || at > face.high(i)) return kMiss;
  }
  return t;
}

}  // namespace

SyntheticCorridor::SyntheticCorridor(const CorridorCase& setup, std::uint64_t seed)
    : setup_(setup), random_(seed, "synthetic_corridor") {
  const double end = half_length();
  const double side = 0.5 * setup.width + std::abs(setup.depth);
  for (const double z : {0.0, setup.height}) {
    faces_.push_back({2, {-end, -side, z}, {end, side, z}});
  }
  add_wall(0.5 * setup.width, 1.0);
  add_wall(-0.5 * setup.width, -1.0);
}

void SyntheticCorridor::add_wall(double y, double outward) {
  const double top = setup_.height;
  const double end = half_length();
  const auto along = [&](double from, double to, double at) {
    faces_.push_back({1, {from, at, 0.0}, {to, at, top}});
  };
  const double raised = y - outward * setup_.depth;
  double x = -end;
  if (setup_.spacing > 0.0) {
    for (double next = x + 1.0; next + setup_.breadth < end; next += setup_.spacing) {
      along(x, next, y);
      x = next + setup_.breadth;
      along(next, x, raised);
      for (const double edge : {next, x}) {
        faces_.push_back({0, {edge, std::min(y, raised), 0.0}, {edge, std::max(y, raised), top}});
      }
    }
  }
  along(x, end, y);
}

ScanPair SyntheticCorridor::scan(const Eigen::Vector3d& sensor) {
  ScanPair result;
  const double turn = random_.uniform();
  for (int column = 0; column < kColumns; ++column) {
    const double azimuth = 2.0 * M_PI * (column + turn) / kColumns;
    for (int ring = 0; ring < setup_.rings; ++ring) {
      const double elevation = setup_.elevation * (2.0 * ring / (setup_.rings - 1.0) - 1.0);
      const Eigen::Vector3d beam(std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      double nearest = setup_.range;
      for (const Face& face : faces_) {
        nearest = std::min(nearest, distance_to(face, sensor, beam));
      }
      if (nearest >= setup_.range) continue;
      LidarPoint point;
      point.position = (nearest * beam).cast<float>();
      result.exact.points.push_back(point);
      point.position += (setup_.noise * random_.normal() * beam).cast<float>();
      result.noisy.points.push_back(point);
    }
  }
  return result;
}

}  // namespace aims::test
