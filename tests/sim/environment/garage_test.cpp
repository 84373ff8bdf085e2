// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/garage.hpp"

#include "sim/environment/scene_mjcf.hpp"
#include "tests/sim/environment/scene_checks.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;
using testing::distance;

const Vector3d kX = Vector3d::UnitX();
const Vector3d kY = Vector3d::UnitY();
const Vector3d kZ = Vector3d::UnitZ();

SceneConfig garage() {
  SceneConfig config;
  config.kind = SceneKind::kGarage;
  return config;
}

SceneConfig smooth_garage() {
  SceneConfig config = garage();
  config.garage.doors.sides = WallSides::kNone;
  config.garage.cars = 0;
  return config;
}

TEST(GarageScene, CorridorsHaveTheConfiguredCrossSectionAndDeadEnds) {
  const RayCaster caster(build_scene(smooth_garage(), 1));
  for (double s = 0.0; s < 36.5; s += 1.3) {
    const Vector3d first(s, 0.2, 0.7);
    EXPECT_NEAR(distance(caster, first, kY), 0.9, 1e-4);
    EXPECT_NEAR(distance(caster, first, -kY), 1.3, 1e-4);
    EXPECT_NEAR(distance(caster, first, kZ), 1.9, 1e-4);
    EXPECT_NEAR(distance(caster, first, -kZ), 0.7, 1e-4);
    const Vector3d second(45.2, -45.0 + s, 0.7);
    EXPECT_NEAR(distance(caster, second, kX), 0.9, 1e-4);
    EXPECT_NEAR(distance(caster, second, -kX), 1.3, 1e-4);
    EXPECT_NEAR(distance(caster, second, kZ), 1.9, 1e-4);
  }
  EXPECT_NEAR(distance(caster, {0.0, 0.3, 1.0}, -kX), 3.0, 1e-4) << "end wall behind a";
  EXPECT_NEAR(distance(caster, {45.3, -45.0, 1.0}, -kY), 3.0, 1e-4) << "end wall behind h";
}

TEST(GarageScene, CorridorsOpenIntoTheHall) {
  const RayCaster caster(build_scene(smooth_garage(), 1));
  // Along both corridors the view is free to the gate and to the far wall of the hall.
  EXPECT_NEAR(distance(caster, {0.0, 0.0, 1.0}, kX), 57.25, 1e-3) << "through the mouth to a gate";
  EXPECT_NEAR(distance(caster, {45.0, -45.0, 1.0}, kY), 57.0, 1e-3) << "through the other mouth";
  // Just within the hall the walls beside the mouths are hit, and the pieces above them.
  EXPECT_NEAR(distance(caster, {40.0, 1.3, 1.0}, -kX), 3.0, 1e-4);
  EXPECT_NEAR(distance(caster, {40.0, -1.3, 1.0}, -kX), 3.0, 1e-4);
  EXPECT_NEAR(distance(caster, {40.0, 0.0, 2.7}, -kX), 3.0, 1e-4);
  EXPECT_NEAR(distance(caster, {43.7, -5.0, 1.0}, -kY), 3.0, 1e-4);
  EXPECT_NEAR(distance(caster, {45.0, -5.0, 2.7}, -kY), 3.0, 1e-4);
  EXPECT_NEAR(distance(caster, {45.0, 0.0, 1.0}, kZ), 2.2, 1e-4) << "the hall is higher";
}

TEST(GarageScene, TheUpwardRampRisesByAFifth) {
  const RayCaster caster(build_scene(smooth_garage(), 1));
  for (double x = 51.0; x < 56.5; x += 0.5) {
    EXPECT_NEAR(distance(caster, {x, -5.8, 2.0}, -kZ), 2.0 - 0.2 * (x - 50.6), 1e-4) << x;
  }
}

TEST(GarageScene, CarsStandInTheirBaysClearOfEachOther) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const Scene scene = build_scene(garage(), seed);
    const Scene empty = build_scene(smooth_garage(), seed);
    std::vector<Solid> cars;
    for (const Solid& solid : scene.solids) {
      if (solid.collides && solid.half_extents.x() == 2.1) cars.push_back(solid);
    }
    ASSERT_EQ(cars.size(), 5U);
    for (std::size_t i = 0; i < cars.size(); ++i) {
      const Vector3d at = cars[i].T_world_solid.translation;
      for (const double along : {-2.1, 0.0, 2.1}) {
        for (const double across : {-0.87, 0.87}) {
          const Vector3d point = cars[i].T_world_solid * Vector3d(along, across, 0.0);
          EXPECT_FALSE(is_inside_solid(empty, point, 0.2)) << "seed " << seed << ", car " << i;
        }
      }
      if (i > 0) {
        EXPECT_GT(at.x() - cars[i - 1].T_world_solid.translation.x(), 1.74 + 0.4);
      }
    }
  }
}

TEST(GarageScene, TheRouteIsFree) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Scene scene = build_scene(garage(), seed);
    for (double s = 0.0; s <= 45.0; s += 0.1) {
      ASSERT_FALSE(is_inside_solid(scene, {s, 0.0, 0.29}, 0.8)) << s;
      ASSERT_FALSE(is_inside_solid(scene, {45.0, -s, 0.29}, 0.8)) << s;
    }
  }
}

TEST(GarageScene, NoRayLeaksOut) {
  testing::expect_no_leak(build_scene(garage(), 1), {{0.0, 0.0, 0.5},
                                                     {36.9, 0.0, 0.5},
                                                     {45.0, 0.0, 0.5},
                                                     {45.0, -8.1, 0.5},
                                                     {45.0, -30.0, 0.5},
                                                     {55.0, 4.0, 1.5}});
}

TEST(GarageScene, StaysSmallForThePhysics) {
  EXPECT_LT(testing::colliding_solids(build_scene(garage(), 1)), 30);
}

TEST(GarageScene, SameSeedSameSceneOtherSeedOtherCars) {
  const auto mjcf = [](std::uint64_t seed) {
    return scene_mjcf(build_scene(garage(), seed), "", MjcfPurpose::kRender).value();
  };
  EXPECT_EQ(mjcf(1), mjcf(1));
  EXPECT_NE(mjcf(1), mjcf(2));
}

TEST(GarageScene, ConfigurationsThatCannotBeBuiltNameTheKey) {
  const auto error = [](auto change) {
    SceneConfig config = garage();
    change(config.garage);
    const auto ok = validate(config);
    return ok ? std::string() : ok.error().message;
  };
  const auto names = [](const std::string& message, const char* key) {
    return message.find(key) != std::string::npos;
  };
  EXPECT_EQ(error([](GarageConfig&) {}), "");
  EXPECT_TRUE(
      names(error([](GarageConfig& c) { c.hall_height = 2.5; }), "scene.garage.hall_height"));
  EXPECT_TRUE(names(error([](GarageConfig& c) { c.height = 3.3; }), "scene.garage.hall_height"));
  EXPECT_TRUE(
      names(error([](GarageConfig& c) { c.opening_distance = 44.5; }), "scene.garage.approach"));
  EXPECT_TRUE(names(error([](GarageConfig& c) { c.exit = 8.0; }), "scene.garage.exit"));
  EXPECT_TRUE(
      names(error([](GarageConfig& c) { c.doors.spacing = 1.0; }), "scene.garage.doors.spacing"));
}

}  // namespace
}  // namespace aims
