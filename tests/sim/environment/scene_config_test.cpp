// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/scene_config.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/environment/ray_caster.hpp"
#include "sim/environment/scene_mjcf.hpp"
#include "tests/sim/environment/scene_checks.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;
using testing::distance;

SceneConfig plain_corridor() {
  SceneConfig config;
  config.corridor.doors.sides = WallSides::kNone;
  return config;
}

/// An opening in a wall as rays measure it.
struct MeasuredOpening {
  double begin = 0.0;
  double end = 0.0;
  double depth = 0.0;
};

/// Openings in the wall towards `side` (+1 left, -1 right), seen at 1 m height every 5 mm.
std::vector<MeasuredOpening> measure_openings(const RayCaster& caster, double side) {
  std::vector<MeasuredOpening> openings;
  bool open = false;
  for (double x = -2.9; x < 81.5; x += 0.005) {
    const double behind = distance(caster, {x, 0.0, 1.0}, {0.0, side, 0.0}) - 1.1;
    if (behind > 1e-3 && !open) openings.push_back({x, x, behind});
    open = behind > 1e-3;
    if (open) openings.back().end = x;
  }
  return openings;
}

TEST(CorridorScene, HasTheConfiguredCrossSectionAndLength) {
  const RayCaster caster(build_scene(plain_corridor(), 1));
  for (double x = 0.0; x <= 78.6; x += 1.3) {
    const Vector3d point(x, 0.2, 0.7);
    EXPECT_NEAR(distance(caster, point, Vector3d::UnitY()), 0.9, 1e-5);
    EXPECT_NEAR(distance(caster, point, -Vector3d::UnitY()), 1.3, 1e-5);
    EXPECT_NEAR(distance(caster, point, Vector3d::UnitZ()), 1.9, 1e-5);
    EXPECT_NEAR(distance(caster, point, -Vector3d::UnitZ()), 0.7, 1e-5);
  }
  EXPECT_NEAR(distance(caster, {0.0, 0.0, 1.0}, Vector3d::UnitX()), 81.6, 1e-4);
  EXPECT_NEAR(distance(caster, {0.0, 0.0, 1.0}, -Vector3d::UnitX()), 3.0, 1e-4);
}

TEST(CorridorScene, PlainOneIsSevenBoxesAtKnownPlaces) {
  SceneConfig config = plain_corridor();
  config.corridor.length = 20.0;
  config.corridor.margin = 3.0;
  const Scene scene = build_scene(config, 1);
  struct KnownBox {
    Vector3d centre, half;
    bool collides, visible;
  };
  // A slab that collides and a face that is seen for each wall, two ends, and the ceiling.
  const std::vector<KnownBox> boxes = {{{10.0, 1.2, 1.3}, {13.2, 0.1, 1.3}, true, false},
                                       {{10.0, 1.2, 1.3}, {13.2, 0.1, 1.35}, false, true},
                                       {{10.0, -1.2, 1.3}, {13.2, 0.1, 1.3}, true, false},
                                       {{10.0, -1.2, 1.3}, {13.2, 0.1, 1.35}, false, true},
                                       {{-3.1, 0.0, 1.3}, {0.1, 1.5, 1.35}, true, true},
                                       {{23.1, 0.0, 1.3}, {0.1, 1.5, 1.35}, true, true},
                                       {{10.0, 0.0, 2.7}, {13.2, 1.5, 0.1}, false, true}};
  ASSERT_EQ(scene.solids.size(), boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Solid& solid = scene.solids[i];
    EXPECT_TRUE(solid.T_world_solid.translation.isApprox(boxes[i].centre, 1e-12)) << i;
    EXPECT_TRUE(solid.half_extents.isApprox(boxes[i].half, 1e-12)) << i;
    EXPECT_TRUE(solid.T_world_solid.rotation.coeffs() == Eigen::Quaterniond::Identity().coeffs());
    EXPECT_EQ(solid.collides, boxes[i].collides) << i;
    EXPECT_EQ(solid.visible, boxes[i].visible) << i;
    EXPECT_EQ(solid.roof, i == 6) << i;
  }
}

TEST(CorridorScene, FeaturesThatAreOffChangeNothing) {
  SceneConfig config;
  const std::string plain = scene_mjcf(build_scene(config, 3), "", MjcfPurpose::kRender).value();
  config.corridor.glass = {
      .fraction = 0.0, .pane_length = 5.0, .max_incidence_deg = 30.0, .backing_distance = 3.0};
  config.ramp = {.start = 1.0, .length = 2.0, .grade = 0.0};
  config.people = {.count = 0, .speed = 2.0, .lane_offset = 5.0};
  config.garage.cars = 1;
  config.tunnel.radius = 7.0;
  ASSERT_TRUE(validate(config));
  EXPECT_EQ(scene_mjcf(build_scene(config, 3), "", MjcfPurpose::kRender).value(), plain);
}

TEST(Scene, EveryKindIsTheSameTwice) {
  for (const SceneKind kind :
       {SceneKind::kCorridor, SceneKind::kGarage, SceneKind::kJunction, SceneKind::kTunnel}) {
    SceneConfig config;
    config.kind = kind;
    const auto product = [&](MjcfPurpose purpose) {
      return scene_mjcf(build_scene(config, 4), "", purpose).value();
    };
    for (const MjcfPurpose purpose : {MjcfPurpose::kPhysics, MjcfPurpose::kRender}) {
      EXPECT_EQ(product(purpose), product(purpose)) << static_cast<int>(kind);
    }
  }
}

TEST(CorridorScene, RecessesHaveTheConfiguredSizeAndSpacing) {
  SceneConfig config;
  config.corridor.doors.jitter = 0.0;
  const RayCaster caster(build_scene(config, 1));
  EXPECT_TRUE(measure_openings(caster, 1.0).empty());
  const auto openings = measure_openings(caster, -1.0);
  ASSERT_EQ(openings.size(), 10U);
  for (std::size_t i = 0; i < openings.size(); ++i) {
    EXPECT_NEAR(openings[i].depth, 0.15, 1e-4);
    EXPECT_NEAR(openings[i].end - openings[i].begin, 0.9, 0.011);
    if (i > 0) {
      EXPECT_NEAR(openings[i].begin - openings[i - 1].begin, 8.0, 0.011);
    }
    const double x = 0.5 * (openings[i].begin + openings[i].end);
    EXPECT_NEAR(distance(caster, {x, 0.0, 2.04}, -Vector3d::UnitY()), 1.25, 1e-4);
    EXPECT_NEAR(distance(caster, {x, 0.0, 2.06}, -Vector3d::UnitY()), 1.1, 1e-4) << "lintel";
    EXPECT_NEAR(distance(caster, {x, -1.15, 1.0}, Vector3d::UnitZ()), 1.05, 1e-4) << "lintel";
    EXPECT_NEAR(distance(caster, {x, -1.2, 1.0}, Vector3d::UnitX()), 0.45, 0.006) << "jamb";
  }
}

TEST(CorridorScene, JitterMovesDoorsWithinItsBounds) {
  SceneConfig config;
  config.corridor.doors.jitter = 0.5;
  const auto openings = measure_openings(RayCaster(build_scene(config, 5)), -1.0);
  ASSERT_EQ(openings.size(), 10U);
  double largest = 0.0;
  for (std::size_t i = 0; i < openings.size(); ++i) {
    const double shift = 0.5 * (openings[i].begin + openings[i].end) - (1.0 + 8.0 * i);
    largest = std::max(largest, std::abs(shift));
  }
  EXPECT_LE(largest, 0.51);
  EXPECT_GT(largest, 0.1);
}

TEST(CorridorScene, SidesDecideWhereDoorsAre) {
  const auto counts = [](WallSides sides) {
    SceneConfig config;
    config.corridor.doors.sides = sides;
    const RayCaster caster(build_scene(config, 1));
    return std::pair(measure_openings(caster, 1.0).size(), measure_openings(caster, -1.0).size());
  };
  EXPECT_EQ(counts(WallSides::kNone), std::pair(0UL, 0UL));
  EXPECT_EQ(counts(WallSides::kLeft), std::pair(10UL, 0UL));
  EXPECT_EQ(counts(WallSides::kBoth), std::pair(10UL, 10UL));
  EXPECT_EQ(counts(WallSides::kAlternate), std::pair(5UL, 5UL));
}

TEST(CorridorScene, OpenEndsLetRaysOut) {
  SceneConfig config = plain_corridor();
  const auto closed = [&](EndWalls ends) {
    config.corridor.end_walls = ends;
    const RayCaster caster(build_scene(config, 1));
    const Vector3d point(40.0, 0.0, 1.0);
    return std::pair(caster.cast(point, -Vector3d::UnitX()).has_value(),
                     caster.cast(point, Vector3d::UnitX()).has_value());
  };
  EXPECT_EQ(closed(EndWalls::kNone), std::pair(false, false));
  EXPECT_EQ(closed(EndWalls::kStart), std::pair(true, false));
  EXPECT_EQ(closed(EndWalls::kEnd), std::pair(false, true));
  EXPECT_EQ(closed(EndWalls::kBoth), std::pair(true, true));
}

TEST(CorridorScene, PillarsStandOutOfTheWallAndCollide) {
  SceneConfig config = plain_corridor();
  config.corridor.pillars.spacing = 10.0;
  const Scene scene = build_scene(config, 1);
  const RayCaster caster(scene);
  EXPECT_NEAR(distance(caster, {7.0, 0.0, 1.0}, Vector3d::UnitY()), 0.95, 1e-4);
  EXPECT_NEAR(distance(caster, {7.0, 0.0, 1.0}, -Vector3d::UnitY()), 0.95, 1e-4);
  EXPECT_NEAR(distance(caster, {7.25, 0.0, 1.0}, Vector3d::UnitY()), 1.1, 1e-4);
  EXPECT_TRUE(is_inside_solid(scene, {7.0, 1.0, 1.0}, 0.0));
}

TEST(CorridorScene, ClutterKeepsTheMiddleFree) {
  SceneConfig config = plain_corridor();
  config.corridor.clutter.density = 1.0;
  config.corridor.clutter.free_width = 1.3;
  const Scene scene = build_scene(config, 9);
  const auto is_clutter = [](const Solid& s) { return s.visible && !s.roof && !s.collides; };
  const auto objects = std::count_if(scene.solids.begin(), scene.solids.end(), is_clutter);
  EXPECT_GE(objects, 80);
  for (double x = -2.5; x < 81.0; x += 0.05) {
    for (const double y : {-0.6, 0.0, 0.6}) {
      for (const double z : {0.2, 0.7, 1.2}) {
        ASSERT_FALSE(is_inside_solid(scene, {x, y, z}, 0.049)) << x << " " << y << " " << z;
      }
    }
  }
}

TEST(CorridorScene, CollidingSolidsStayFew) {
  SceneConfig config;
  config.corridor.doors.sides = WallSides::kBoth;
  config.corridor.doors.spacing = 2.5;
  config.corridor.pillars.spacing = 5.0;
  config.corridor.clutter.density = 3.0;
  ASSERT_TRUE(validate(config));
  const Scene scene = build_scene(config, 1);
  EXPECT_GT(scene.solids.size(), 200U);
  EXPECT_LT(std::count_if(scene.solids.begin(), scene.solids.end(),
                          [](const Solid& solid) { return solid.collides; }),
            50);
}

TEST(CorridorScene, FloorBumpsHaveTheConfiguredHeightAndCorrelation) {
  SceneConfig config = plain_corridor();
  config.bumps = {.height = 0.02, .correlation_length = 0.6};
  const Floor floor = build_scene(config, 4).floor;
  ASSERT_EQ(floor.heights.size(), static_cast<std::size_t>(floor.columns) * floor.rows);
  const auto [low, high] = std::minmax_element(floor.heights.begin(), floor.heights.end());
  EXPECT_GE(*low, 0.0F);
  EXPECT_LE(*high, 0.02F);
  EXPECT_GT(*high - *low, 0.018F);
  const double step = (floor.max_corner - floor.min_corner).x() / (floor.columns - 1);
  const int lag = static_cast<int>(std::lround(0.6 / step));
  double products = 0.0;
  double squares = 0.0;
  for (int row = 0; row < floor.rows; ++row) {
    for (int column = 0; column + lag < floor.columns; ++column) {
      const double here = floor.heights[row * floor.columns + column] - 0.01;
      const double there = floor.heights[row * floor.columns + column + lag] - 0.01;
      products += here * there;
      squares += here * here;
    }
  }
  // Correlation of the ranks of a Gaussian field whose own correlation is exp(-1/2).
  const double expected = 6.0 / M_PI * std::asin(0.5 * std::exp(-0.5));
  EXPECT_NEAR(products / squares, expected, 0.12);
}

bool same(const Scene& a, const Scene& b) {
  return a.floor.heights == b.floor.heights &&
         std::equal(a.solids.begin(), a.solids.end(), b.solids.begin(), b.solids.end(),
                    [](const Solid& one, const Solid& other) {
                      return one.T_world_solid.translation == other.T_world_solid.translation &&
                             one.half_extents == other.half_extents && one.shape == other.shape;
                    });
}

TEST(Scene, RepeatsWithItsSeedAndOnlyWithIt) {
  SceneConfig config;
  config.bumps.height = 0.01;
  config.corridor.clutter.density = 0.5;
  EXPECT_TRUE(same(build_scene(config, 1), build_scene(config, 1)));
  EXPECT_FALSE(same(build_scene(config, 1), build_scene(config, 2)));
  config.seed = 8;
  EXPECT_TRUE(same(build_scene(config, 1), build_scene(config, 2))) << "its own seed holds";
}

TEST(Scene, SeparatesFreePointsFromSolidOnes) {
  const Scene scene = build_scene(plain_corridor(), 1);
  EXPECT_FALSE(is_inside_solid(scene, {0.0, 0.0, 0.4}, 0.5));
  EXPECT_FALSE(is_inside_solid(scene, {40.0, 0.8, 0.4}, 0.29));
  EXPECT_TRUE(is_inside_solid(scene, {40.0, 0.8, 0.4}, 0.31));
  EXPECT_TRUE(is_inside_solid(scene, {40.0, 1.15, 0.4}, 0.0));
  EXPECT_TRUE(is_inside_solid(scene, {-3.1, 0.0, 0.4}, 0.0));
}

TEST(SceneConfig, EveryParameterTakesItsOwnText) {
  SceneConfig config;
  const Fields fields = fields_of(config);
  for (const Parameter& each : fields.parameters()) {
    EXPECT_TRUE(each.assign(each.text())) << each.key << " = " << each.text();
    EXPECT_FALSE(each.spec.meaning.empty()) << each.key;
  }
  EXPECT_NE(fields.find("corridor.doors.depth"), nullptr);
}

TEST(SceneConfig, RejectsWhatCannotBeBuilt) {
  const auto message = [](auto change) {
    SceneConfig config;
    change(config.corridor);
    const auto valid = validate(config);
    return valid ? std::string() : valid.error().message;
  };
  const auto names = [&](const std::string& key, auto change) {
    return message(change).starts_with("scene.corridor." + key + ": expected");
  };
  EXPECT_EQ(message([](CorridorConfig&) {}), "");
  EXPECT_TRUE(names("doors.spacing", [](CorridorConfig& c) { c.doors.spacing = 1.5; }));
  EXPECT_TRUE(names("doors.height", [](CorridorConfig& c) { c.doors.height = 2.7; }));
  EXPECT_TRUE(names("pillars.spacing", [](CorridorConfig& c) { c.pillars.spacing = 0.3; }));
  EXPECT_TRUE(names("pillars.spacing", [](CorridorConfig& c) { c.pillars.spacing = 2.0; }));
  EXPECT_TRUE(names("pillars.depth", [](CorridorConfig& c) {
    c.pillars.spacing = 8.0;
    c.pillars.depth = 0.7;
  }));
  EXPECT_TRUE(names("clutter.free_width", [](CorridorConfig& c) { c.clutter = {1.0, 2.1}; }));
}

}  // namespace
}  // namespace aims
