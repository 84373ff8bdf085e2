// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/scene_route.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/environment/corridor_pieces.hpp"

namespace aims {

namespace {

constexpr double kLongestChord = 1.25;  ///< of a tunnel's arc [m]

/// From a to b along the points.
std::vector<RoutePoint> from_a_to_b(const std::vector<Eigen::Vector2d>& points) {
  std::vector<RoutePoint> route;
  for (const Eigen::Vector2d& point : points) route.push_back({"", point.x(), point.y()});
  route.front().name = std::string("a");  // GCC 12 warns of a literal
  route.back().name = std::string("b");
  return route;
}

std::vector<Eigen::Vector2d> arc_of(const TunnelConfig& tunnel) {
  std::vector<Eigen::Vector2d> points;
  const double chords = std::ceil(tunnel.length / kLongestChord);
  for (double i = 0.0; i <= chords; i += 1.0) {
    const double angle = i / chords * tunnel.length / tunnel.radius;
    points.emplace_back(tunnel.radius * std::sin(angle), tunnel.radius * (1.0 - std::cos(angle)));
  }
  return points;
}

std::vector<RoutePoint> one_way(const SceneConfig& scene) {
  const GarageConfig& garage = scene.garage;
  const JunctionConfig& junction = scene.junction;
  switch (scene.kind) {
    case SceneKind::kCorridor:
      return from_a_to_b(centre_line(scene.corridor));
    case SceneKind::kTunnel:
      return from_a_to_b(arc_of(scene.tunnel));
    case SceneKind::kGarage:
      return {{"a", 0.0, 0.0}, {"d", garage.approach, 0.0}, {"h", garage.approach, -garage.exit}};
    case SceneKind::kJunction:
      return {
          {"a", 0.0, 0.0}, {"j", junction.length, 0.0}, {"b", junction.length, -junction.branch}};
    case SceneKind::kLoop:
      break;
  }
  return {};
}

/// Around the block and back to a, as often as there are laps, by b on the opposite side.
std::vector<RoutePoint> around(const LoopConfig& loop) {
  std::vector<RoutePoint> route = {{"a", 0.0, 0.0}};
  const std::vector<CorridorPiece> sides = loop_pieces(loop);
  const auto turn = [&](std::size_t side) {
    std::vector<Eigen::Vector2d> points;
    add_bend(sides[side], points);
    for (const Eigen::Vector2d& each : points) route.push_back({"", each.x(), each.y()});
  };
  for (int lap = 0; lap < loop.laps; ++lap) {
    turn(0);
    turn(1);
    route.push_back({"b", 0.0, loop.depth});
    turn(2);
    turn(3);
    route.push_back({"a", 0.0, 0.0});
  }
  return route;
}

}  // namespace

std::vector<RoutePoint> points_along(const SceneConfig& scene) {
  if (scene.kind == SceneKind::kLoop) return around(scene.loop);
  std::vector<RoutePoint> points = one_way(scene);
  for (std::size_t i = points.size() - 1; i-- > 0;) points.push_back(points[i]);
  return points;
}

RouteConfig route_in(const SceneConfig& scene, const RouteConfig& route) {
  RouteConfig followed = route;
  if (route.follow_scene) followed.points = points_along(scene);
  return followed;
}

const char* length_key(SceneKind kind) {
  switch (kind) {
    case SceneKind::kTunnel:
      return "scene.tunnel.length";
    case SceneKind::kGarage:
      return "scene.garage.approach";
    case SceneKind::kJunction:
      return "scene.junction.length";
    case SceneKind::kLoop:
      return "scene.loop.length";
    case SceneKind::kCorridor:
      break;
  }
  return "scene.corridor.length";
}

std::string route_hint(SceneKind kind) {
  return fmt::format(
      "{} and route.points go together: change both, or set route.follow_scene=true, which walks "
      "to the far end and back",
      length_key(kind));
}

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
