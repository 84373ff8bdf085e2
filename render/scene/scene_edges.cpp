// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/scene_edges.hpp"

#include <cmath>
#include <numbers>

namespace aims {
namespace {

using Line = std::vector<Eigen::Vector3f>;

/// A line through points of the solid's frame, in units of its half extents.
Line line_of(const Solid& solid, const std::vector<Eigen::Vector3d>& points) {
  Line line;
  for (const Eigen::Vector3d& point : points) {
    line.push_back(
        (solid.T_world_solid * point.cwiseProduct(solid.half_extents).eval()).cast<float>());
  }
  return line;
}

void add_box(const Solid& solid, std::vector<Line>& edges) {
  // Lower face, up, and upper face; then the three uprights that are left.
  edges.push_back(line_of(solid, {{-1, -1, -1},
                                  {1, -1, -1},
                                  {1, 1, -1},
                                  {-1, 1, -1},
                                  {-1, -1, -1},
                                  {-1, -1, 1},
                                  {1, -1, 1},
                                  {1, 1, 1},
                                  {-1, 1, 1},
                                  {-1, -1, 1}}));
  edges.push_back(line_of(solid, {{1, -1, -1}, {1, -1, 1}}));
  edges.push_back(line_of(solid, {{1, 1, -1}, {1, 1, 1}}));
  edges.push_back(line_of(solid, {{-1, 1, -1}, {-1, 1, 1}}));
}

void add_cylinder(const Solid& solid, std::vector<Line>& edges) {
  constexpr int kCorners = 24;
  for (const double z : {-1.0, 1.0}) {
    std::vector<Eigen::Vector3d> circle;
    for (int i = 0; i <= kCorners; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kCorners;
      circle.emplace_back(std::cos(angle), std::sin(angle), z);
    }
    edges.push_back(line_of(solid, circle));
  }
}

}  // namespace

std::vector<std::vector<Eigen::Vector3f>> scene_edges(const Scene& scene) {
  std::vector<Line> edges;
  for (const Solid& solid : scene.solids) {
    if (!solid.visible || solid.roof) continue;
    if (solid.shape == Shape::kBox) {
      add_box(solid, edges);
    } else {
      add_cylinder(solid, edges);
    }
  }
  return edges;
}

}  // namespace aims
