// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/route_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace aims {
namespace {

constexpr double kSlack = 0.01;       ///< by which loose objects at a point may be nearer [m]
constexpr double kStep = 0.05;        ///< between places that are looked at on the way [m]
constexpr double kRoofMargin = 0.05;  ///< by which ceilings may miss each other [m]

Eigen::Vector2d place(const RoutePoint& point) { return {point.x, point.y}; }

std::string text_of(const Eigen::Vector2d& point) {
  return fmt::format("({:.6g}, {:.6g})", point.x(), point.y());
}

Eigen::Vector3d trunk_at(const Scene& scene, const Eigen::Vector2d& point, double body_height) {
  const double ground = floor_height(scene.floor, point.x(), point.y());
  return {point.x(), point.y(), ground + body_height};
}

bool is_below(const Solid& roof, const Eigen::Vector2d& point) {
  const Eigen::Vector3d at(point.x(), point.y(), roof.T_world_solid.translation.z());
  const Eigen::Vector3d local = roof.T_world_solid.inverse() * at;
  return (local.head<2>().array().abs() <= roof.half_extents.head<2>().array() + kRoofMargin).all();
}

/// On the floor and, where the scene has ceilings, below one of them.
bool is_inside_building(const Scene& scene, const Eigen::Vector2d& point) {
  if ((point.array() < scene.floor.min_corner.array()).any() ||
      (point.array() > scene.floor.max_corner.array()).any()) {
    return false;
  }
  bool roofed = false;
  for (const Solid& solid : scene.solids) {
    if (!solid.roof) continue;
    if (is_below(solid, point)) return true;
    roofed = true;
  }
  return !roofed;
}

/// The solids that stop a robot.
Scene obstacles_of(const Scene& scene) {
  Scene obstacles = scene;
  std::erase_if(obstacles.solids, [](const Solid& solid) { return !solid.collides; });
  return obstacles;
}

/// The first place on the way where the robot would touch a solid.
std::optional<Eigen::Vector2d> first_obstacle(const Scene& obstacles, const Eigen::Vector2d& from,
                                              const Eigen::Vector2d& to, const BodySize& body) {
  const double steps = std::max(1.0, std::ceil((to - from).norm() / kStep));
  for (double i = 0.0; i <= steps; i += 1.0) {
    const Eigen::Vector2d at = from + i / steps * (to - from);
    if (is_inside_solid(obstacles, trunk_at(obstacles, at, body.height), body.half_width))
      return at;
  }
  return std::nullopt;
}

Result<void> check_points(const RouteConfig& route, const Scene& scene, const BodySize& body) {
  for (std::size_t i = 0; i < route.points.size(); ++i) {
    const Eigen::Vector2d at = place(route.points[i]);
    if (!is_inside_building(scene, at)) {
      return failure(fmt::format(
          "route.points.{}: {} is outside the building, whose floor extends from {} to {} m", i,
          text_of(at), text_of(scene.floor.min_corner), text_of(scene.floor.max_corner)));
    }
    if (is_inside_solid(scene, trunk_at(scene, at, body.height), body.half_width - kSlack)) {
      return failure(fmt::format("route.points.{}: {} is inside a wall or object of the scene", i,
                                 text_of(at)));
    }
  }
  return {};
}

}  // namespace

Result<void> check_walkable(const RouteConfig& route, const Scene& scene, const BodySize& body) {
  if (auto ok = check_points(route, scene, body); !ok) return ok;
  const Scene obstacles = obstacles_of(scene);
  for (std::size_t i = 1; i < route.points.size(); ++i) {
    const Eigen::Vector2d from = place(route.points[i - 1]);
    const Eigen::Vector2d to = place(route.points[i]);
    if (const auto hit = first_obstacle(obstacles, from, to, body)) {
      return failure(fmt::format(
          "route.points.{}: a wall or object of the scene stands in the way from {} (points.{}) to "
          "{}; the robot would touch it at {}",
          i, text_of(from), i - 1, text_of(to), text_of(*hit)));
    }
  }
  return {};
}

}  // namespace aims
