// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/scene_geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace aims {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr int kShownSides = 12;      ///< of a cylinder
constexpr int kMostFloorCells = 64;  ///< along one side

/// Upper and lower outline of a solid, in its own frame: corner i of both is above one another.
struct Prism {
  std::vector<Vector3d> bottom;
  std::vector<Vector3d> top;
};

Prism prism_of(const Solid& solid) {
  const Vector3d& half = solid.half_extents;
  Prism prism;
  const bool box = solid.shape == Shape::kBox;
  const int sides = box ? 4 : kShownSides;
  for (int i = 0; i < sides; ++i) {
    const double angle = (i + 0.5) * 2.0 * std::numbers::pi / sides;
    // Corners of a box lie at the signs of cosine and sine.
    const double x = box ? std::copysign(half.x(), std::cos(angle)) : half.x() * std::cos(angle);
    const double y = box ? std::copysign(half.y(), std::sin(angle)) : half.x() * std::sin(angle);
    prism.bottom.emplace_back(x, y, -half.z());
    prism.top.emplace_back(x, y, half.z());
  }
  for (auto* outline : {&prism.bottom, &prism.top}) {
    for (Vector3d& corner : *outline) corner = solid.T_world_solid * corner;
  }
  return prism;
}

void add_line(const Vector3d& a, const Vector3d& b, std::vector<Vector3f>& edges) {
  edges.push_back(a.cast<float>());
  edges.push_back(b.cast<float>());
}

void add_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                  std::vector<Vector3f>& triangles) {
  for (const Vector3d* corner : {&a, &b, &c}) triangles.push_back(corner->cast<float>());
}

void add_solid(const Solid& solid, SurfaceGeometry& geometry) {
  const auto [bottom, top] = prism_of(solid);
  for (std::size_t i = 0; i < bottom.size(); ++i) {
    const std::size_t next = (i + 1) % bottom.size();
    add_line(bottom[i], bottom[next], geometry.edges);
    add_line(top[i], top[next], geometry.edges);
    add_line(bottom[i], top[i], geometry.edges);
    add_triangle(bottom[i], bottom[next], top[next], geometry.triangles);
    add_triangle(bottom[i], top[next], top[i], geometry.triangles);
    if (i == 0 || next == 0) continue;
    add_triangle(top[0], top[i], top[next], geometry.triangles);
    add_triangle(bottom[0], bottom[next], bottom[i], geometry.triangles);
  }
}

/// Cells of a floor that are shown along one of its sides.
int shown_cells(const Floor& floor, int points) {
  return floor.heights.empty() ? 1 : std::clamp(points - 1, 1, kMostFloorCells);
}

void add_floor(const Floor& floor, SurfaceGeometry& geometry) {
  const int columns = shown_cells(floor, floor.columns);
  const int rows = shown_cells(floor, floor.rows);
  const auto at = [&](int column, int row) {
    const Eigen::Vector2d fraction(static_cast<double>(column) / columns,
                                   static_cast<double>(row) / rows);
    const Eigen::Vector2d place =
        floor.min_corner + fraction.cwiseProduct(floor.max_corner - floor.min_corner);
    return Vector3d(place.x(), place.y(), floor_height(floor, place.x(), place.y()));
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Vector3d a = at(column, row);
      const Vector3d b = at(column + 1, row);
      const Vector3d c = at(column + 1, row + 1);
      const Vector3d d = at(column, row + 1);
      add_triangle(a, b, c, geometry.triangles);
      add_triangle(a, c, d, geometry.triangles);
      if (row == 0) add_line(a, b, geometry.edges);
      if (row == rows - 1) add_line(d, c, geometry.edges);
      if (column == 0) add_line(a, d, geometry.edges);
      if (column == columns - 1) add_line(b, c, geometry.edges);
    }
  }
}

Json people_json(const Scene& scene) {
  return json_array(scene.people, [](const Person& person) {
    return Json{{"from", {person.from.x(), person.from.y()}},
                {"to", {person.to.x(), person.to.y()}},
                {"turn", person.turn},
                {"ground", person.ground},
                {"speed", person.speed},
                {"start", person.start},
                {"radius", person.radius},
                {"height", person.height}};
  });
}

std::vector<float> numbers_of(const std::vector<Vector3f>& points) {
  std::vector<float> numbers;
  for (const Vector3f& p : points) numbers.insert(numbers.end(), {p.x(), p.y(), p.z()});
  return numbers;
}

}  // namespace

SceneGeometry scene_geometry(const Scene& scene) {
  SceneGeometry geometry;
  add_floor(scene.floor, geometry.open);
  for (const Solid& solid : scene.solids) {
    if (solid.visible) add_solid(solid, solid.roof ? geometry.roofs : geometry.open);
  }
  return geometry;
}

Json scene_json(const Scene& scene, PageData& page) {
  const SceneGeometry geometry = scene_geometry(scene);
  Vector3f min = geometry.open.edges.front();
  Vector3f max = min;
  for (const Vector3f& point : geometry.open.edges) {
    min = min.cwiseMin(point);
    max = max.cwiseMax(point);
  }
  const Floor& floor = scene.floor;
  return {{"floor",
           {{"min", {floor.min_corner.x(), floor.min_corner.y()}},
            {"max", {floor.max_corner.x(), floor.max_corner.y()}},
            {"flat", floor.heights.empty()}}},
          {"bounds", {{"min", {min.x(), min.y(), min.z()}}, {"max", {max.x(), max.y(), max.z()}}}},
          {"edges", page.f32(numbers_of(geometry.open.edges))},
          {"triangles", page.f32(numbers_of(geometry.open.triangles))},
          {"roof_edges", page.f32(numbers_of(geometry.roofs.edges))},
          {"roof_triangles", page.f32(numbers_of(geometry.roofs.triangles))},
          {"people", people_json(scene)}};
}

}  // namespace aims
