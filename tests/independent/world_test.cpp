// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/world.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "tests/independent/cells.hpp"

namespace aims::independent {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t kSeed = 7;

TEST(World, CorridorDistancesAreAnalytic) {
  const World world = make_cell("doors_30")->world;
  const Vector3d origin(0.0, 0.0, 0.5);
  EXPECT_NEAR(world.distance(origin, -Vector3d::UnitY()), 1.1, 1e-12);
  EXPECT_NEAR(world.distance(origin, -Vector3d::UnitZ()), 0.5, 1e-12);
  EXPECT_NEAR(world.distance(origin, Vector3d::UnitZ()), 2.1, 1e-12);
  EXPECT_NEAR(world.distance(origin, Vector3d::UnitX()), 81.6, 1e-12);
  EXPECT_NEAR(world.distance(origin, -Vector3d::UnitX()), 3.0, 1e-12);
  EXPECT_NEAR(world.distance(origin, Vector3d::UnitY()), 1.1, 1e-12);
  EXPECT_NEAR(world.distance({2.5, 0.0, 0.5}, Vector3d::UnitY()), 1.25, 1e-12);
  EXPECT_NEAR(world.distance({2.5, 0.0, 2.2}, Vector3d::UnitY()), 1.1, 1e-12);
  EXPECT_NEAR(world.distance({10.5, 0.0, 0.5}, Vector3d::UnitY()), 1.25, 1e-12);
}

TEST(World, ARayIntoARecessStopsAtItsJamb) {
  const World world = make_cell("doors_30")->world;
  // From y = 0 at 45 degrees it passes the wall plane at x = 2.95 and the jamb x = 3 at y = 1.15.
  const double half = std::sqrt(0.5);
  EXPECT_NEAR(world.distance({1.85, 0.0, 0.5}, {half, half, 0.0}), 1.15 / half, 1e-12);
}

TEST(World, RecessDepthFollowsTheCell) {
  const Vector3d origin(2.5, 0.0, 0.5);
  for (const auto& [name, depth] :
       {std::pair{"recess5_30", 0.05}, std::pair{"recess2_30", 0.02}, std::pair{"plain_30", 0.0}}) {
    EXPECT_NEAR(make_cell(name)->world.distance(origin, Vector3d::UnitY()), 1.1 + depth, 1e-12);
  }
}

TEST(World, NothingEndsTheOpenCorridorWithinRange) {
  const Cell cell = *make_cell("plain_open_30");
  for (const double x : {0.0, 40.0, cell.length}) {
    EXPECT_GT(cell.world.distance({x, 0.0, 0.5}, Vector3d::UnitX()), 100.0);
    EXPECT_GT(cell.world.distance({x, 0.0, 0.5}, -Vector3d::UnitX()), 100.0);
  }
}

TEST(World, PillarIsHitWhereItsCircleIs) {
  World world{Box(Vector3d(-10, -10, 0), Vector3d(10, 10, 3)), {}, {}, {{5.0, 0.0, 0.5}}};
  EXPECT_NEAR(world.distance({0.0, 0.0, 1.0}, Vector3d::UnitX()), 4.5, 1e-12);
  EXPECT_NEAR(world.distance({0.0, 0.3, 1.0}, Vector3d::UnitX()), 4.6, 1e-12);
  EXPECT_NEAR(world.distance({0.0, 0.6, 1.0}, Vector3d::UnitX()), 10.0, 1e-12);
  EXPECT_NEAR(world.distance({0.0, 0.0, 1.0}, -Vector3d::UnitX()), 10.0, 1e-12);
  EXPECT_NEAR(world.distance({0.0, 0.0, 1.0}, Vector3d(0.8, 0.0, 0.6)), 2.0 / 0.6, 1e-12);
}

/// Whether the point is before all sides of the room.
bool in_room(const World& world, const Vector3d& point) {
  if (!world.relief) return world.room.contains(point);
  for (int axis = 0; axis < 3; ++axis) {
    const double above = point[axis] - world.room.min()[axis];
    const double below = world.room.max()[axis] - point[axis];
    if (above < -world.relief->height({axis, false}, point)) return false;
    if (below < -world.relief->height({axis, true}, point)) return false;
  }
  return true;
}

/// The recess, which cuts through the wall before it where that stands out.
Box carved(const World& world, const Box& recess) {
  Vector3d before = recess.center();
  before.y() = recess.min().y() - (world.relief ? world.relief->bound() : 0.0);
  Box box = recess;
  return box.extend(before);
}

/// Whether the point is in the air, from the definition of the world.
bool in_air(const World& world, const Vector3d& point) {
  bool air = in_room(world, point);
  for (const Box& recess : world.recesses) air = air || carved(world, recess).contains(point);
  for (const Box& box : world.boxes) air = air && !box.contains(point);
  for (const Pillar& pillar : world.pillars) {
    air = air && std::hypot(point.x() - pillar.x, point.y() - pillar.y) > pillar.radius;
  }
  return air;
}

TEST(World, DistanceAgreesWithMarchingThroughTheAir) {
  std::printf("seed %lu\n", static_cast<unsigned long>(kSeed));
  RandomStream random(kSeed, "rays");
  for (const auto& [name, relief] :
       {std::pair{"garage_30", 0.0}, std::pair{"doors_30", 0.0}, std::pair{"doors_30", 0.003},
        std::pair{"recess2_30", 0.003}}) {
    World world = make_cell(name)->world;
    if (relief > 0.0) world.relief = std::make_shared<Relief>(world.room, relief, kSeed);
    for (int i = 0; i < 400; ++i) {
      const Vector3d origin(random.uniform(0.0, 50.0), random.uniform(-0.5, 0.5), 0.5);
      const Vector3d direction = random.normal3().cwiseProduct(Vector3d(1, 1, 0.2)).normalized();
      const double distance = world.distance(origin, direction);
      for (double t = 0.01; t < distance - 1e-6; t += 0.01) {
        ASSERT_TRUE(in_air(world, origin + t * direction)) << name << " ray " << i << " at " << t;
      }
      ASSERT_FALSE(in_air(world, origin + (distance + 1e-6) * direction))
          << name << " ray " << i << " relief " << relief;
    }
  }
}

TEST(World, SolidsOutOfRangeDoNotMatter) {
  RandomStream random(kSeed, "near");
  World world = make_cell("garage_30")->world;
  const Vector3d origin(25.0, 0.2, 0.5);
  for (const bool uneven : {false, true}) {
    if (uneven) world.relief = std::make_shared<Relief>(world.room, 0.003, kSeed);
    const World near = world.within(origin, 10.0);
    EXPECT_LT(near.boxes.size(), world.boxes.size());
    for (int i = 0; i < 1000; ++i) {
      const Vector3d direction = random.normal3().normalized();
      const double distance = world.distance(origin, direction);
      if (distance >= 10.0) continue;
      EXPECT_EQ(near.distance(origin, direction), distance);
    }
  }
}

TEST(Cells, AnUnknownNameIsAnError) {
  const auto cell = make_cell("doors");
  ASSERT_FALSE(cell);
  EXPECT_NE(cell.error().message.find("doors_100"), std::string::npos);
}

}  // namespace
}  // namespace aims::independent
