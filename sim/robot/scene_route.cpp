// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/scene_route.hpp"

#include <algorithm>
#include <cmath>

#include "sim/environment/corridor_pieces.hpp"

namespace aims {
namespace {

constexpr double kLongestChord = 1.25;  ///< of a tunnel's arc [m]

/// From a to b along the points.
std::vector<RoutePoint> from_a_to_b(const std::vector<Eigen::Vector2d>& points) {
  std::vector<RoutePoint> route;
  for (const Eigen::Vector2d& point : points) route.push_back({"", point.x(), point.y()});
  route.front().name = "a";
  route.back().name = "b";
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

}  // namespace aims
