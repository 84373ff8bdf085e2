// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/angle.hpp"
#include "sim/environment/corridor_pieces.hpp"
#include "sim/robot/scene_route.hpp"
#include "tests/sim/environment/scene_checks.hpp"

namespace aims {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::distance;

/// 20 m of route with the bends given; doors set back by 15 cm on both sides.
SceneConfig bent(std::vector<BendConfig> bends, double width = 2.2) {
  SceneConfig config;
  config.corridor.length = 20.0;
  config.corridor.width = width;
  config.corridor.bends = std::move(bends);
  config.corridor.doors.sides = WallSides::kBoth;
  config.corridor.doors.spacing = 3.0;
  return config;
}

const std::vector<std::vector<BendConfig>> kShapes = {
    {{0.5, 15.0, Side::kLeft}},
    {{0.5, 90.0, Side::kRight}},
    {{0.3, 90.0, Side::kLeft}, {0.7, 90.0, Side::kLeft}},
    {{0.3, 60.0, Side::kLeft}, {0.7, 45.0, Side::kRight}},
    {{0.2, 30.0, Side::kRight}, {0.5, 0.0, Side::kLeft}, {0.8, 75.0, Side::kRight}}};

/// The centre line at arc length s along straight pieces, by dead reckoning; heading [rad].
struct Place {
  Vector2d point;
  double heading;
};
Place place_at(const SceneConfig& config, double s) {
  Place place{Vector2d::Zero(), 0.0};
  const auto go = [&place](double step) {
    place.point += step * Vector2d(std::cos(place.heading), std::sin(place.heading));
  };
  double walked = 0.0;
  for (const BendConfig& bend : config.corridor.bends) {
    const double at = bend.at * config.corridor.length;
    if (s <= at) break;
    go(at - walked);
    walked = at;
    place.heading +=
        (bend.side == Side::kLeft ? kRadiansPerDegree : -kRadiansPerDegree) * bend.angle_deg;
  }
  go(s - walked);
  return place;
}

/// Distance from the nearest bend of the centre line [m].
double from_bend(const SceneConfig& config, double s) {
  double nearest = 1e9;
  for (const BendConfig& bend : config.corridor.bends) {
    nearest = std::min(nearest, std::abs(s - bend.at * config.corridor.length));
  }
  return nearest;
}

TEST(BentCorridor, WallsAreHalfAWidthFromTheCentreLine) {
  for (auto bends : kShapes) {
    SceneConfig config = bent(bends);
    config.corridor.doors.sides = WallSides::kNone;
    ASSERT_TRUE(validate(config));
    const RayCaster caster(build_scene(config, 1));
    for (double s = -2.9; s < 22.9; s += 0.31) {
      if (from_bend(config, s) < 1.15) continue;  // half the width times tan 45 degrees, and more
      const Place here = place_at(config, s);
      const Vector3d origin(here.point.x(), here.point.y(), 1.0);
      const Vector3d left(-std::sin(here.heading), std::cos(here.heading), 0.0);
      EXPECT_NEAR(distance(caster, origin, left), 1.1, 1e-4) << s;
      EXPECT_NEAR(distance(caster, origin, -left), 1.1, 1e-4) << s;
      EXPECT_NEAR(distance(caster, origin, Vector3d::UnitZ()), 1.6, 1e-4) << s;
      EXPECT_NEAR(distance(caster, origin, -Vector3d::UnitZ()), 1.0, 1e-4) << s;
    }
    const Place end = place_at(config, 22.0);
    const Vector3d ahead(std::cos(end.heading), std::sin(end.heading), 0.0);
    EXPECT_NEAR(distance(caster, {end.point.x(), end.point.y(), 1.0}, ahead), 1.0, 1e-4);
    EXPECT_NEAR(distance(caster, {0.0, 0.0, 1.0}, -Vector3d::UnitX()), 3.0, 1e-4);
  }
}

TEST(BentCorridor, CornersAreMitred) {
  for (const double angle : {15.0, 45.0, 90.0}) {
    SceneConfig config = bent({{0.5, angle, Side::kLeft}});
    config.corridor.doors.sides = WallSides::kNone;
    const RayCaster caster(build_scene(config, 1));
    // Both corners lie on the bisector of the bend. Beside it a ray meets the nearer of the outer
    // faces, whose planes bound a convex space, and the farther of the inner ones.
    const double half = 0.5 * angle * kRadiansPerDegree;
    for (const double aside : {-0.02, 0.0, 0.02}) {
      const double bisector = 0.5 * std::numbers::pi + half + aside;
      const Vector3d inwards(std::cos(bisector), std::sin(bisector), 0.0);
      const double inner = 1.1 / std::cos(half + std::abs(aside));
      const double outer = 1.1 / std::cos(half - std::abs(aside));
      EXPECT_NEAR(distance(caster, {10.0, 0.0, 1.0}, inwards), inner, 1e-4) << angle;
      EXPECT_NEAR(distance(caster, {10.0, 0.0, 1.0}, -inwards), outer, 1e-4) << angle;
    }
  }
}

TEST(BentCorridor, NoRayLeaksOut) {
  for (const auto& bends : kShapes) {
    for (const double width : {1.2, 2.2, 4.0}) {
      SceneConfig config = bent(bends, width);
      config.corridor.clutter.density = width > 2.0 ? 0.5 : 0.0;
      ASSERT_TRUE(validate(config)) << validate(config).error().message;
      const Scene scene = build_scene(config, 3);
      std::vector<Vector3d> inside;
      for (const Vector2d& point : centre_line(config.corridor)) {
        inside.emplace_back(point.x(), point.y(), 0.5);
      }
      testing::expect_no_leak(scene, inside);
      EXPECT_LT(testing::colliding_solids(scene), 12);
    }
  }
}

TEST(BentCorridor, RecessesOfOnePieceStayOutOfTheOther) {
  for (const auto& bends : kShapes) {
    SceneConfig config = bent(bends);
    config.corridor.doors.depth = 0.2;
    config.corridor.doors.spacing = 1.5;
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
      const RayCaster caster(build_scene(config, seed));
      for (double s = -2.9; s < 22.9; s += 0.043) {
        if (from_bend(config, s) < 1.15) continue;
        const Place here = place_at(config, s);
        const Vector3d left(-std::sin(here.heading), std::cos(here.heading), 0.0);
        for (const double side : {-1.0, 1.0}) {
          const double far = distance(caster, {here.point.x(), here.point.y(), 1.0}, side * left);
          EXPECT_TRUE(std::abs(far - 1.1) < 1e-4 || std::abs(far - 1.3) < 1e-4) << far;
        }
      }
    }
  }
}

TEST(BentCorridor, RouteStaysInsideAndComesBack) {
  for (const auto& bends : kShapes) {
    for (const double width : {1.2, 2.2, 4.0}) {
      const SceneConfig config = bent(bends, width);
      RouteConfig route;
      route.follow_scene = true;
      route = route_in(config, route);
      ASSERT_TRUE(validate(route));
      const auto walkable = check_walkable(route, build_scene(config, 1), BodySize{});
      EXPECT_TRUE(walkable) << walkable.error().message;
      const Place end = place_at(config, 20.0);
      const RoutePoint& far = route.points[route.points.size() / 2];
      EXPECT_EQ(far.name, "b");
      EXPECT_NEAR(far.x, end.point.x(), 1e-9);
      EXPECT_NEAR(far.y, end.point.y(), 1e-9);
      EXPECT_EQ(route.points.front().name, "a");
      EXPECT_EQ(route.points.back().name, "a");
      for (const RoutePoint& point : route.points) {
        const bool named =
            &point == &route.points.front() || &point == &route.points.back() || &point == &far;
        EXPECT_EQ(point.name.empty(), !named);
      }
    }
  }
}

/// Beyond a right angle a bend is two of half the angle, so that walls with a thickness fit.
TEST(BentCorridor, TurnsByAnyAngleUpToAUTurn) {
  for (const double angle : {100.0, 120.0, 150.0, 180.0}) {
    for (const Side side : {Side::kLeft, Side::kRight}) {
      SceneConfig config = bent({{0.5, angle, side}});
      SCOPED_TRACE(angle);
      ASSERT_TRUE(validate(config)) << validate(config).error().message;
      const auto pieces = corridor_pieces(config.corridor);
      ASSERT_EQ(pieces.size(), 3U);
      const double heading = yaw_of(pieces.back().T_world_piece.rotation);
      const double turned = (side == Side::kLeft ? 1.0 : -1.0) * angle * kRadiansPerDegree;
      EXPECT_NEAR(std::abs(wrap_angle(heading - turned)), 0.0, 1e-9);
      const Scene scene = build_scene(config, 2);
      std::vector<Vector3d> inside;
      for (const Vector2d& point : centre_line(config.corridor)) {
        inside.emplace_back(point.x(), point.y(), 0.5);
      }
      testing::expect_no_leak(scene, inside);
      RouteConfig route;
      route.follow_scene = true;
      const auto walkable = check_walkable(route_in(config, route), scene, BodySize{});
      EXPECT_TRUE(walkable) << walkable.error().message;
    }
  }
}

TEST(BentCorridor, WithoutAngleIsTheStraightCorridor) {
  const Scene straight = build_scene(bent({}), 5);
  const Scene zero = build_scene(bent({{0.4, 0.0, Side::kRight}}), 5);
  ASSERT_EQ(straight.solids.size(), zero.solids.size());
  for (std::size_t i = 0; i < straight.solids.size(); ++i) {
    EXPECT_EQ(straight.solids[i].half_extents, zero.solids[i].half_extents);
    EXPECT_EQ(straight.solids[i].T_world_solid.translation,
              zero.solids[i].T_world_solid.translation);
  }
}

TEST(BentCorridor, PeopleWalkInsideTheLongestPiece) {
  SceneConfig config = bent({{0.3, 60.0, Side::kLeft}, {0.9, 45.0, Side::kRight}});
  config.people.count = 20;
  ASSERT_TRUE(validate(config));
  const Scene scene = build_scene(config, 2);
  ASSERT_EQ(scene.people.size(), 20U);
  for (const Person& person : scene.people) {
    for (const Vector2d& turning : {person.from, person.to}) {
      EXPECT_FALSE(is_inside_solid(scene, {turning.x(), turning.y(), 1.0}, person.radius));
    }
    EXPECT_NEAR(std::atan2(person.to.y() - person.from.y(), person.to.x() - person.from.x()),
                60.0 * kRadiansPerDegree, 1e-9);
  }
}

TEST(BentCorridor, RejectsWhatCannotBeBuilt) {
  const auto message = [](auto change) {
    SceneConfig config = bent({{0.3, 90.0, Side::kLeft}, {0.7, 90.0, Side::kLeft}});
    change(config);
    const auto valid = validate(config);
    return valid ? std::string() : valid.error().message;
  };
  EXPECT_EQ(message([](SceneConfig&) {}), "");
  const auto starts = [&](const char* text, auto change) {
    EXPECT_TRUE(message(change).starts_with(text)) << message(change);
  };
  starts("scene.corridor.bends: expected at least",
         [](SceneConfig& c) { c.corridor.bends[1].at = 0.35; });
  starts("scene.corridor.bends: expected at least",
         [](SceneConfig& c) { c.corridor.bends[1].at = 0.2; });
  starts("scene.corridor.bends: expected pieces of corridor that keep apart", [](SceneConfig& c) {
    c.corridor.width = 4.0;
    c.corridor.doors.depth = 0.4;
    c.corridor.bends[0].at = 0.4;
    c.corridor.bends[1].at = 0.66;
  });
  starts("scene.corridor.pillars", [](SceneConfig& c) { c.corridor.pillars.spacing = 5.0; });
  starts("scene.corridor.glass", [](SceneConfig& c) { c.corridor.glass.fraction = 0.2; });
  starts("scene.ramp.grade", [](SceneConfig& c) { c.ramp.grade = 0.05; });
}

}  // namespace
}  // namespace aims
