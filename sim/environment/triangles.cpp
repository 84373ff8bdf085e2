// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/triangles.hpp"

#include <cmath>
#include <numbers>

namespace aims {
namespace {

void add_vertex(const Solid& solid, const Eigen::Vector3d& point, TriangleMesh& mesh) {
  mesh.vertices.emplace_back((solid.T_world_solid * point).cast<float>());
}

void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d,
              TriangleMesh& mesh) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

TriangleMesh triangulate_box(const Solid& solid) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d signs((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                                (corner & 4) != 0 ? 1.0 : -1.0);
    add_vertex(solid, signs.cwiseProduct(solid.half_extents), mesh);
  }
  add_quad(0, 2, 3, 1, mesh);  // -z
  add_quad(4, 5, 7, 6, mesh);  // +z
  add_quad(0, 1, 5, 4, mesh);  // -y
  add_quad(2, 6, 7, 3, mesh);  // +y
  add_quad(0, 4, 6, 2, mesh);  // -x
  add_quad(1, 3, 7, 5, mesh);  // +x
  return mesh;
}

/// Vertices: bottom and top of each edge in turn, then the two centres.
TriangleMesh triangulate_cylinder(const Solid& solid) {
  TriangleMesh mesh;
  const double step = 2.0 * std::numbers::pi / kCylinderSides;
  // Flat sides lie between the radius times cos(step / 2) and the radius of the edges.
  const double radius = solid.half_extents.x() * 2.0 / (1.0 + std::cos(0.5 * step));
  const double half_height = solid.half_extents.z();
  for (int side = 0; side < kCylinderSides; ++side) {
    const double x = radius * std::cos(side * step);
    const double y = radius * std::sin(side * step);
    add_vertex(solid, {x, y, -half_height}, mesh);
    add_vertex(solid, {x, y, half_height}, mesh);
  }
  add_vertex(solid, {0.0, 0.0, -half_height}, mesh);
  add_vertex(solid, {0.0, 0.0, half_height}, mesh);
  constexpr std::uint32_t kBottom = 2 * kCylinderSides;
  constexpr std::uint32_t kTop = kBottom + 1;
  for (std::uint32_t side = 0; side < kCylinderSides; ++side) {
    const std::uint32_t here = 2 * side;
    const std::uint32_t next = 2 * ((side + 1) % kCylinderSides);
    add_quad(here, next, next + 1, here + 1, mesh);
    mesh.triangles.push_back({kBottom, next, here});
    mesh.triangles.push_back({kTop, here + 1, next + 1});
  }
  return mesh;
}

}  // namespace

TriangleMesh triangulate(const Solid& solid) {
  return solid.shape == Shape::kBox ? triangulate_box(solid) : triangulate_cylinder(solid);
}

TriangleMesh triangulate(const Floor& floor) {
  const bool flat = floor.heights.empty();
  const int columns = flat ? 2 : floor.columns;
  const int rows = flat ? 2 : floor.rows;
  const Eigen::Vector2d size = floor.max_corner - floor.min_corner;
  TriangleMesh mesh;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double x = floor.min_corner.x() + size.x() * column / (columns - 1);
      const double y = floor.min_corner.y() + size.y() * row / (rows - 1);
      const float z = flat ? 0.0F : floor.heights[mesh.vertices.size()];
      mesh.vertices.emplace_back(static_cast<float>(x), static_cast<float>(y), z);
    }
  }
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      const auto here = static_cast<std::uint32_t>(row * columns + column);
      const auto above = here + static_cast<std::uint32_t>(columns);
      // The same diagonal as in MuJoCo's height fields.
      add_quad(here, here + 1, above + 1, above, mesh);
    }
  }
  return mesh;
}

}  // namespace aims
