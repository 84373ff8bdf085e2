// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/map_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <unordered_set>

#include "render/plots/scene_plan.hpp"

namespace aims {
namespace {

using Eigen::Vector3f;

constexpr float kFinestCube = 0.02F;  ///< edge [m]
constexpr float kCoarsening = 1.1F;   ///< of the edge, from one try to the next, at least
constexpr int kCubeBits = 21;         ///< of a cube's index along one axis
constexpr unsigned kCurveBits = 16;   ///< of a place along one axis of the space-filling curve

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

/// The bits of three places in [0, 2^16), interleaved: the index along a Z-order curve.
std::uint64_t morton_code(const Vector3f& place) {
  std::uint64_t code = 0;
  for (unsigned bit = 0; bit < kCurveBits; ++bit) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      const auto along = static_cast<std::uint64_t>(place[static_cast<int>(axis)]);
      code |= (along >> bit & 1U) << (3U * bit + axis);
    }
  }
  return code;
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

std::size_t most_points(std::size_t maps) {
  return std::min(kMostMapPoints, kMostPagePoints / std::max<std::size_t>(maps, 1));
}

std::vector<std::size_t> ordered_in_space(std::span<const Vector3f> points,
                                          const std::vector<bool>& first) {
  Vector3f low = Vector3f::Constant(std::numeric_limits<float>::max());
  Vector3f high = -low;
  for (const Vector3f& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const float size = points.empty() ? 1.0F : std::max((high - low).maxCoeff(), 1e-6F);
  std::vector<std::uint64_t> keys;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3f place = (points[i] - low) / size * static_cast<float>((1U << kCurveBits) - 1U);
    keys.push_back((first[i] ? 0U : 1ULL << 3U * kCurveBits) | morton_code(place));
  }
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return keys[i]; });
  return order;
}

Json map_json(std::span<const Vector3f> points, const Pose& T_world_odom,
              const SurfaceDistance* surface, std::size_t most, bool roofed, PageData& page) {
  if (points.empty()) return {};
  std::vector<Vector3f> cloud = thinned_cloud(points, most);
  for (Vector3f& point : cloud) point = (T_world_odom * point.cast<double>()).cast<float>();
  const auto below =
      roofed ? under_roof(cloud, kCeilingCut) : std::vector<bool>(cloud.size(), true);
  std::vector<double> places;
  std::vector<std::uint8_t> errors;
  for (const std::size_t i : ordered_in_space(cloud, below)) {
    places.insert(places.end(), {cloud[i].x(), cloud[i].y(), cloud[i].z()});
    if (surface == nullptr) continue;
    const float fraction = (*surface)(cloud[i], kLargestMapError) / kLargestMapError;
    errors.push_back(static_cast<std::uint8_t>(std::lround(255.0F * fraction)));
  }
  return {{"n", cloud.size()},
          {"points", points.size()},
          {"below", std::count(below.begin(), below.end(), true)},
          {"p", page.q16(places, 3, {.least_step = kMapStep, .relative = 0.0})},
          {"error", surface == nullptr ? Json() : page.u8(errors)},
          {"error_max", kLargestMapError}};
}

}  // namespace aims
