// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/route.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace aims {
namespace {

/// A point mass that does exactly what it is told, at once.
struct Unicycle {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double yaw = 0.0;

  Pose pose() const { return {yaw_rotation(yaw), {position.x(), position.y(), 0.3}}; }
  void move(const VelocityCommand& command, double dt) {
    yaw += command.yaw_rate * dt;
    position += Eigen::Rotation2Dd(yaw) * command.velocity * dt;
  }
};

struct Followed {
  std::vector<WaypointTime> waypoint_times;
  std::vector<Eigen::Vector2d> path;
  bool done = false;
  double duration = 0.0;
};

Followed follow(const RouteConfig& route) {
  RouteFollower follower(route);
  Unicycle robot{{route.points[0].x, route.points[0].y}, start_heading(route)};
  Followed result;
  const double dt = 0.0025;
  Time now = 0;
  while (!follower.done() && now < 300 * kSecond) {
    const VelocityCommand command = follower.command(now, robot.pose(), true, 0.0);
    robot.move(command, dt);
    now += from_seconds(dt);
    result.path.push_back(robot.position);
  }
  result.waypoint_times = follower.waypoint_times();
  result.done = follower.done();
  result.duration = to_seconds(now);
  return result;
}

TEST(Route, NeedsTwoPointsApart) {
  RouteConfig route;
  route.points = {{"a", 0.0, 0.0}};
  EXPECT_FALSE(validate(route));
  route.points.push_back({"b", 0.0, 0.0});
  const auto same = validate(route);
  ASSERT_FALSE(same);
  EXPECT_NE(same.error().message.find("route.points.1"), std::string::npos);
  route.points[1].x = 5.0;
  EXPECT_TRUE(validate(route));
}

TEST(Route, PassesItsNamedPointsInOrderAndStops) {
  RouteConfig route;
  route.points = {{"a", 0, 0}, {"b", 5, 0}, {"", 5, 4}, {"c", 1, 4}, {"a", 0, 0}};
  const Followed walk = follow(route);
  EXPECT_TRUE(walk.done);
  ASSERT_EQ(walk.waypoint_times.size(), 4U);
  EXPECT_EQ(walk.waypoint_times[1].point, "b");
  EXPECT_EQ(walk.waypoint_times[2].point, "c");
  EXPECT_EQ(walk.waypoint_times[3].point, "a");
  const auto at_c = static_cast<std::size_t>(walk.waypoint_times[2].stamp / from_seconds(0.0025));
  EXPECT_LT((walk.path[at_c - 1] - Eigen::Vector2d(1.0, 4.0)).norm(), 0.05);
  EXPECT_NEAR(walk.duration, to_seconds(from_seconds(nominal_duration(route))), 8.0);
}

TEST(Route, WalksSidewaysAndBackwardAlongTheSameLine) {
  for (const double sideslip : {0.5 * std::numbers::pi, std::numbers::pi, -1.0}) {
    RouteConfig route;
    route.points = {{"a", 0, 0}, {"b", 6, 3}, {"a", 0, 0}};
    route.sideslip = sideslip;
    EXPECT_NEAR(wrap_angle(start_heading(route) - (std::atan2(3.0, 6.0) - sideslip)), 0.0, 1e-12);
    const Followed walk = follow(route);
    ASSERT_TRUE(walk.done) << sideslip;
    const Eigen::Vector2d across = Eigen::Vector2d(-3.0, 6.0).normalized();
    for (const Eigen::Vector2d& p : walk.path) ASSERT_LT(std::abs(p.dot(across)), 0.05) << sideslip;
    RouteConfig forward = route;
    forward.sideslip = 0.0;
    EXPECT_NEAR(nominal_duration(route), nominal_duration(forward), 1e-9);
    EXPECT_NEAR(walk.duration, follow(forward).duration, 0.2) << sideslip;
  }
}

TEST(Route, ReturnsAlongALineAfterTurningInPlace) {
  RouteConfig route;
  route.points = {{"a", 0, 0}, {"b", 8, 0}, {"a", 0, 0}};
  const Followed walk = follow(route);
  ASSERT_TRUE(walk.done);
  for (const Eigen::Vector2d& p : walk.path) {
    EXPECT_LT(std::abs(p.y()), 0.05);
    EXPECT_LT(p.x(), 8.05);
  }
}

TEST(Route, StartsTowardsItsSecondPoint) {
  RouteConfig route;
  route.points = {{"a", 1, 1}, {"b", 1, 4}};
  EXPECT_NEAR(start_heading(route), std::numbers::pi / 2.0, 1e-12);
}

}  // namespace
}  // namespace aims
