// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/scene.hpp"

#include <algorithm>
#include <cmath>

namespace aims {

double Person::distance() const {
  const double chord = (to - from).norm();
  return turn == 0.0 ? chord : chord * 0.5 * turn / std::sin(0.5 * turn);
}

Eigen::Vector2d Person::position(Time stamp) const {
  const double whole = distance();
  const double walked = std::fmod(start + speed * to_seconds(stamp), 2.0 * whole);
  const double from_begin = walked <= whole ? walked : 2.0 * whole - walked;
  if (turn == 0.0) return from + from_begin / whole * (to - from);
  // The chord from the begin turns by half of what the arc turns.
  const double turned = from_begin / whole * turn;
  const Eigen::Rotation2Dd towards(0.5 * (turned - turn));
  return from + std::sin(0.5 * turned) / std::sin(0.5 * turn) * (towards * (to - from));
}

double floor_height(const Floor& floor, double x, double y) {
  if (floor.heights.empty()) return 0.0;
  const Eigen::Vector2d size = floor.max_corner - floor.min_corner;
  const double u =
      std::clamp((x - floor.min_corner.x()) / size.x(), 0.0, 1.0) * (floor.columns - 1);
  const double v = std::clamp((y - floor.min_corner.y()) / size.y(), 0.0, 1.0) * (floor.rows - 1);
  const int column = std::min(static_cast<int>(u), floor.columns - 2);
  const int row = std::min(static_cast<int>(v), floor.rows - 2);
  const double right = u - column;
  const double up = v - row;
  const auto at = [&](int dx, int dy) {
    return static_cast<double>(floor.heights[(row + dy) * floor.columns + column + dx]);
  };
  // The cell's diagonal runs from its first corner to the opposite one.
  const double corner = right > up ? at(1, 0) : at(0, 1);
  return right > up ? at(0, 0) + right * (corner - at(0, 0)) + up * (at(1, 1) - corner)
                    : at(0, 0) + up * (corner - at(0, 0)) + right * (at(1, 1) - corner);
}

Scene scene_at(const Scene& scene, Time stamp) {
  Scene still = scene;
  still.people.clear();
  for (const Person& person : scene.people) {
    Solid solid;
    solid.shape = Shape::kCylinder;
    const Eigen::Vector2d at = person.position(stamp);
    solid.T_world_solid.translation = {at.x(), at.y(), person.ground + 0.5 * person.height};
    solid.half_extents = {person.radius, person.radius, 0.5 * person.height};
    solid.material = person.material;
    solid.collides = false;
    still.solids.push_back(solid);
  }
  return still;
}

bool is_inside_solid(const Scene& scene, const Eigen::Vector3d& point, double clearance) {
  return std::any_of(scene.solids.begin(), scene.solids.end(), [&](const Solid& solid) {
    const Eigen::Vector3d local = solid.T_world_solid.inverse() * point;
    Eigen::Vector3d outside = local.cwiseAbs() - solid.half_extents;
    if (solid.shape == Shape::kCylinder) {
      outside.x() = local.head<2>().norm() - solid.half_extents.x();
      outside.y() = 0.0;
    }
    const double distance = outside.cwiseMax(0.0).norm();
    return distance < clearance || outside.maxCoeff() <= 0.0;
  });
}

}  // namespace aims
