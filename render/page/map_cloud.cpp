// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/map_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_set>

namespace aims {
namespace {

using Eigen::Vector3f;

constexpr float kFinestCube = 0.02F;  ///< edge [m]
constexpr float kCoarsening = 1.1F;   ///< of the edge, from one try to the next, at least
constexpr int kCubeBits = 21;         ///< of a cube's index along one axis
constexpr float kSteps = 65535.0F;    ///< of a 16-bit place

/// The cube of a point, as one number; the same for cubes 2^21 edges apart, which only thins.
std::uint64_t cube_of(const Vector3f& point, float edge) {
  std::uint64_t index = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto along = static_cast<std::int64_t>(std::floor(point[axis] / edge));
    index = index << kCubeBits | (static_cast<std::uint64_t>(along) & ((1U << kCubeBits) - 1U));
  }
  return index;
}

/// The first point in each cube.
std::vector<Vector3f> first_in_cubes(std::span<const Vector3f> points, float edge) {
  std::unordered_set<std::uint64_t> taken;
  taken.reserve(points.size());
  std::vector<Vector3f> kept;
  for (const Vector3f& point : points) {
    if (taken.insert(cube_of(point, edge)).second) kept.push_back(point);
  }
  return kept;
}

}  // namespace

std::vector<Vector3f> thinned_cloud(std::span<const Vector3f> points, std::size_t most) {
  std::vector<Vector3f> kept(points.begin(), points.end());
  float edge = kFinestCube;
  while (kept.size() > most) {
    kept = first_in_cubes(kept, edge);
    // Points lie on surfaces: their number falls with the square of the edge.
    const auto excess = static_cast<float>(kept.size()) / static_cast<float>(most);
    edge *= std::max(kCoarsening, std::sqrt(excess));
  }
  return kept;
}

PageData::Json map_json(std::span<const Vector3f> points, const Pose& T_world_odom,
                        const SurfaceDistance* surface, PageData& page) {
  if (points.empty()) return {};
  std::vector<Vector3f> cloud = thinned_cloud(points, kMostMapPoints);
  Vector3f min = Vector3f::Constant(std::numeric_limits<float>::max());
  Vector3f max = -min;
  for (Vector3f& point : cloud) {
    point = (T_world_odom * point.cast<double>()).cast<float>();
    min = min.cwiseMin(point);
    max = max.cwiseMax(point);
  }
  std::vector<std::uint16_t> places;
  std::vector<std::uint8_t> errors;
  for (const Vector3f& point : cloud) {
    for (int axis = 0; axis < 3; ++axis) {
      const float size = max[axis] - min[axis];
      const float fraction = size > 0.0F ? (point[axis] - min[axis]) / size : 0.0F;
      places.push_back(static_cast<std::uint16_t>(std::lround(kSteps * fraction)));
    }
    if (surface == nullptr) continue;
    const float fraction = (*surface)(point, kLargestMapError) / kLargestMapError;
    errors.push_back(static_cast<std::uint8_t>(std::lround(255.0F * fraction)));
  }
  return {{"n", cloud.size()},
          {"points", points.size()},
          {"min", {min.x(), min.y(), min.z()}},
          {"max", {max.x(), max.y(), max.z()}},
          {"p", page.u16(places)},
          {"error", surface == nullptr ? PageData::Json() : page.u8(errors)},
          {"error_max", kLargestMapError}};
}

}  // namespace aims
