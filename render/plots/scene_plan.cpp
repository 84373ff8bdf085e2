// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/scene_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <unordered_map>

namespace aims {

namespace {

std::vector<Eigen::Vector3d> surface_points(const Solid& solid) {
  const Eigen::Vector3d& h = solid.half_extents;
  std::vector<Eigen::Vector3d> points;
  const int around = solid.shape == Shape::kBox ? 4 : 24;
  for (int i = 0; i < around; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / around;
    const double reach = solid.shape == Shape::kBox ? std::numbers::sqrt2 : 1.0;
    for (const double side : {-1.0, 1.0}) {
      points.push_back(solid.T_world_solid * Eigen::Vector3d(reach * h.x() * std::cos(angle),
                                                             reach * h.y() * std::sin(angle),
                                                             side * h.z()));
    }
  }
  return points;
}

/// Twice the area of the triangle; positive when it turns left.
double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

/// Convex hull by monotone chain, counter-clockwise.
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  std::vector<Eigen::Vector2d> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t base = hull.size();
    for (const Eigen::Vector2d& point : points) {
      while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 1e-12)
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

}  // namespace

std::vector<std::vector<Eigen::Vector2d>> scene_plan(const Scene& scene, double min_top,
                                                     double max_bottom) {
  std::vector<std::vector<Eigen::Vector2d>> outlines;
  for (const Solid& solid : scene.solids) {
    if (solid.roof || !solid.visible) continue;
    std::vector<Eigen::Vector2d> points;
    double top = -std::numeric_limits<double>::infinity();
    double bottom = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& point : surface_points(solid)) {
      points.emplace_back(point.head<2>());
      top = std::max(top, point.z());
      bottom = std::min(bottom, point.z());
    }
    if (top >= min_top && bottom <= max_bottom) outlines.push_back(convex_hull(std::move(points)));
  }
  return outlines;
}

std::vector<bool> under_roof(std::span<const Eigen::Vector3f> points, double section) {
  constexpr float kCell = 2.0F;
  const auto cell_of = [](const Eigen::Vector3f& p) {
    const auto column = static_cast<std::int64_t>(std::floor(p.x() / kCell));
    const auto row = static_cast<std::int64_t>(std::floor(p.y() / kCell));
    return (column << 32) + row;
  };
  std::unordered_map<std::int64_t, float> floor;  // looked up only, never iterated
  for (const Eigen::Vector3f& point : points) {
    const auto [entry, fresh] = floor.try_emplace(cell_of(point), point.z());
    if (!fresh) entry->second = std::min(entry->second, point.z());
  }
  std::vector<bool> under;
  under.reserve(points.size());
  for (const Eigen::Vector3f& point : points) {
    under.push_back(point.z() <= floor.at(cell_of(point)) + static_cast<float>(section));
  }
  return under;
}

}  // namespace aims
