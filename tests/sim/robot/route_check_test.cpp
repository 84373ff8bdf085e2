// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/scene_route.hpp"

#include <gtest/gtest.h>

#include <string>

#include "sim/environment/scene_config.hpp"
#include "sim/simulation.hpp"

namespace aims {
namespace {

RouteConfig route_of(std::initializer_list<Eigen::Vector2d> points) {
  RouteConfig route;
  route.points.clear();
  for (const Eigen::Vector2d& point : points) route.points.push_back({"", point.x(), point.y()});
  return route;
}

std::string refusal(const SceneConfig& config, const RouteConfig& route) {
  const auto checked = check_walkable(route, build_scene(config, 1), BodySize{});
  return checked ? "" : checked.error().message;
}

bool mentions(const std::string& message, std::initializer_list<const char*> parts) {
  for (const char* part : parts) {
    if (message.find(part) == std::string::npos) return false;
  }
  return true;
}

SceneConfig corridor(double length) {
  SceneConfig config;
  config.corridor.length = length;
  return config;
}

TEST(RouteCheck, ARouteWithinTheCorridorIsWalkable) {
  EXPECT_EQ(refusal(corridor(6.0), route_of({{0.0, 0.0}, {6.0, 0.5}, {0.0, -0.5}})), "");
}

TEST(RouteCheck, AWiderRobotNeedsMoreRoom) {
  const Scene scene = build_scene(corridor(6.0), 1);  // walls at 1.1 m
  const RouteConfig beside = route_of({{0.0, 0.0}, {6.0, 0.9}});
  EXPECT_TRUE(check_walkable(beside, scene, {.height = 0.5, .half_width = 0.16}));
  EXPECT_FALSE(check_walkable(beside, scene, {.height = 0.5, .half_width = 0.26}));
}

TEST(RouteCheck, APointOutsideTheBuildingIsNamedWithTheExtentOfTheFloor) {
  const std::string message = refusal(corridor(2.0), route_of({{0.0, 0.0}, {30.0, 0.0}}));
  EXPECT_TRUE(mentions(message, {"route.points.1", "(30, 0)", "outside the building", "(5.2,"}))
      << message;
}

TEST(RouteCheck, AScenesLengthAndItsRouteAreNamedTogether) {
  SimulationConfig config;
  config.scene = corridor(2.0);
  config.route = route_of({{0.0, 0.0}, {30.0, 0.0}});
  const auto simulation = Simulation::create(config, 1);
  ASSERT_FALSE(simulation);
  const std::string& message = simulation.error().message;
  EXPECT_TRUE(mentions(message, {"outside the building", "scene.corridor.length", "route.points",
                                 "route.follow_scene=true"}))
      << message;
}

TEST(RouteCheck, APointOutsideIsFoundWithoutEndWallsToo) {
  SceneConfig open = corridor(2.0);
  open.corridor.end_walls = EndWalls::kNone;
  EXPECT_TRUE(mentions(refusal(open, route_of({{0.0, 0.0}, {6.0, 0.0}})), {"route.points.1"}));
}

TEST(RouteCheck, AnEmptyCornerOfTheSitePlanIsOutside) {
  SceneConfig junction;
  junction.kind = SceneKind::kJunction;
  const std::string message = refusal(junction, route_of({{0.0, 6.0}, {3.0, 6.0}}));
  EXPECT_TRUE(mentions(message, {"route.points.0", "outside the building"})) << message;
}

TEST(RouteCheck, AWallBetweenTwoPointsIsNamedWithBoth) {
  SceneConfig junction;  // a corridor along +x that ends in one along y
  junction.kind = SceneKind::kJunction;
  EXPECT_EQ(refusal(junction, route_of({{0.0, 0.0}, {13.0, 0.0}, {13.0, 10.0}})), "");
  const std::string message = refusal(junction, route_of({{0.0, 0.0}, {13.0, 10.0}}));
  EXPECT_TRUE(mentions(message, {"route.points.1", "(0, 0)", "points.0", "(13, 10)", "in the way"}))
      << message;
}

TEST(RouteCheck, ARouteAlongAWallWithoutRoomForTheFeetIsRefused) {
  const std::string message = refusal(corridor(6.0), route_of({{0.0, 0.0}, {6.0, 0.945}}));
  EXPECT_TRUE(mentions(message, {"route.points.1", "touch"})) << message;
}

TEST(RouteCheck, AWallSidePillarIsAnObstacleAndAPersonIsNot) {
  SceneConfig config = corridor(12.0);
  const RouteConfig beside = route_of({{0.0, 0.8}, {12.0, 0.8}});
  EXPECT_EQ(refusal(config, beside), "");
  config.people.count = 20;
  EXPECT_EQ(refusal(config, beside), "");
  config.corridor.pillars.spacing = 4.0;
  config.corridor.pillars.depth = 0.3;
  EXPECT_TRUE(mentions(refusal(config, beside), {"route.points.1", "in the way"}));
}

}  // namespace
}  // namespace aims
