// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/ray_caster.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "core/random.hpp"
#include "sim/environment/scene_config.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint64_t kSeed = 3;

struct Ray {
  Vector3d origin;
  Vector3d direction;
};

struct Expected {
  double distance = kInfinity;
  Vector3d normal = Vector3d::Zero();
};

/// Analytic first crossing of a ray from outside with a box, by slabs in the box's frame.
Expected meet_box(const Solid& solid, const Ray& ray) {
  const Pose T_solid_world = solid.T_world_solid.inverse();
  const Vector3d origin = T_solid_world * ray.origin;
  const Vector3d direction = T_solid_world.rotation * ray.direction;
  double enter = 0.0;
  double leave = kInfinity;
  int axis_of_entry = -1;
  for (int axis = 0; axis < 3; ++axis) {
    const double one = (solid.half_extents[axis] - origin[axis]) / direction[axis];
    const double other = (-solid.half_extents[axis] - origin[axis]) / direction[axis];
    if (std::min(one, other) > enter) {
      enter = std::min(one, other);
      axis_of_entry = axis;
    }
    leave = std::min(leave, std::max(one, other));
  }
  if (axis_of_entry < 0 || enter > leave) return {};
  const Vector3d normal =
      -std::copysign(1.0, direction[axis_of_entry]) * Vector3d::Unit(axis_of_entry);
  return {enter, solid.T_world_solid.rotation * normal};
}

Expected meet_floor(const Floor& floor, const Ray& ray) {
  const double distance = -ray.origin.z() / ray.direction.z();
  const Eigen::Vector2d point = (ray.origin + distance * ray.direction).head<2>();
  const bool inside = (point.array() >= floor.min_corner.array()).all() &&
                      (point.array() <= floor.max_corner.array()).all();
  if (distance <= 0.0 || !inside) return {};
  return {distance, Vector3d::UnitZ()};
}

Vector3d random_direction(RandomStream& random) { return random.normal3().normalized(); }

Scene scattered_boxes(RandomStream& random) {
  Scene scene;
  for (int i = 0; i < 12; ++i) {
    Solid solid;
    solid.T_world_solid.rotation = so3_exp(random.normal3());
    solid.T_world_solid.translation =
        Vector3d(random.uniform(-8.0, 8.0), random.uniform(-8.0, 8.0), random.uniform(2.0, 6.0));
    solid.half_extents =
        Vector3d(random.uniform(0.2, 1.0), random.uniform(0.2, 1.0), random.uniform(0.2, 1.0));
    scene.solids.push_back(solid);
  }
  return scene;
}

bool starts_inside_any(const Scene& scene, const Vector3d& point) {
  for (const Solid& solid : scene.solids) {
    const Vector3d local = solid.T_world_solid.inverse() * point;
    if ((local.cwiseAbs().array() < solid.half_extents.array() + 0.01).all()) return true;
  }
  return false;
}

TEST(RayCaster, AgreesWithAnalyticBoxesAndFloor) {
  RandomStream random = rng(kSeed, "boxes");
  const Scene scene = scattered_boxes(random);
  const RayCaster caster(scene);
  int hits = 0;
  int disagreements = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Ray ray{{random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0), random.uniform(0.1, 7.0)},
                  random_direction(random)};
    if (starts_inside_any(scene, ray.origin)) continue;
    Expected expected = meet_floor(scene.floor, ray);
    for (const Solid& solid : scene.solids) {
      const Expected box = meet_box(solid, ray);
      if (box.distance < expected.distance) expected = box;
    }
    const auto hit = caster.cast(ray.origin, ray.direction);
    const double distance = hit ? hit->distance : kInfinity;
    if (hit) ++hits;
    const bool same = hit ? std::abs(distance - expected.distance) < 1e-4 &&
                                (hit->normal - expected.normal).norm() < 1e-4
                          : expected.distance == kInfinity;
    if (!same) ++disagreements;
  }
  EXPECT_GT(hits, 5000);
  // Only rays that pass within rounding of an edge may differ.
  EXPECT_LE(disagreements, 2) << "seed " << kSeed;
}

TEST(RayCaster, CylindersAreRoundWithinTheirTessellation) {
  Scene scene;
  Solid solid;
  solid.shape = Shape::kCylinder;
  solid.half_extents = Vector3d(0.5, 0.5, 1.0);
  solid.T_world_solid.translation = Vector3d(0.0, 0.0, 1.0);
  scene.solids.push_back(solid);
  const RayCaster caster(scene);
  RandomStream random = rng(kSeed, "cylinder");
  for (int i = 0; i < 5000; ++i) {
    const double bearing = random.uniform(0.0, 6.2831);
    const Vector3d away(std::cos(bearing), std::sin(bearing), 0.0);
    const Vector3d across(-away.y(), away.x(), 0.0);
    const double miss = random.uniform(-0.4, 0.4);  // of the axis, horizontally
    const Vector3d origin = 3.0 * away + miss * across + Vector3d(0, 0, random.uniform(0.2, 1.8));
    const auto hit = caster.cast(origin, -away);
    ASSERT_TRUE(hit);
    const double expected = 3.0 - std::sqrt(0.25 - miss * miss);
    EXPECT_NEAR(hit->distance, expected, 0.002) << "seed " << kSeed;
    const Vector3d radial = (origin - hit->distance * away - Vector3d(0, 0, origin.z())) / 0.5;
    EXPECT_GT(hit->normal.dot(radial), std::cos(0.07));
  }
}

TEST(RayCaster, PacketsAgreeWithSingleRays) {
  RandomStream random = rng(kSeed, "packets");
  const RayCaster caster(scattered_boxes(random));
  for (int i = 0; i < 500; ++i) {
    RayPacket rays;
    for (int lane = 0; lane < kRayPacketSize; ++lane) {
      const Vector3d direction = random_direction(random);
      rays.origin_x[lane] = static_cast<float>(random.uniform(-9.0, 9.0));
      rays.origin_z[lane] = 1.0F;
      rays.direction_x[lane] = static_cast<float>(direction.x());
      rays.direction_y[lane] = static_cast<float>(direction.y());
      rays.direction_z[lane] = static_cast<float>(direction.z());
    }
    HitPacket hits;
    caster.cast(rays, 20.0F, hits, 11);
    for (int lane = 0; lane < kRayPacketSize; ++lane) {
      const auto single = caster.cast(
          {rays.origin_x[lane], rays.origin_y[lane], rays.origin_z[lane]},
          {rays.direction_x[lane], rays.direction_y[lane], rays.direction_z[lane]}, 20.0);
      if (lane >= 11 || !single) {
        EXPECT_EQ(hits.surface[lane], -1);
        EXPECT_TRUE(std::isinf(hits.distance[lane]));
        continue;
      }
      EXPECT_EQ(hits.surface[lane], single->surface);
      EXPECT_NEAR(hits.distance[lane], single->distance, 1e-5);
      const Vector3d normal(hits.normal_x[lane], hits.normal_y[lane], hits.normal_z[lane]);
      EXPECT_NEAR((normal - single->normal).norm(), 0.0, 1e-5);
    }
  }
}

SceneConfig furnished_corridor() {
  SceneConfig config;
  config.corridor.doors.sides = WallSides::kBoth;
  config.corridor.pillars.spacing = 6.0;
  config.corridor.clutter.density = 0.5;
  return config;
}

/// Rays inside the corridor, half of them aimed close to the seams of floor, walls and ceiling.
void fill(RayPacket& rays, const CorridorConfig& corridor, RandomStream& random) {
  const double x = random.uniform(0.0, corridor.length);
  for (int lane = 0; lane < kRayPacketSize; ++lane) {
    const Vector3d origin(x, random.uniform(-0.6, 0.6), random.uniform(0.2, 2.4));
    Vector3d direction = random_direction(random);
    if (lane % 2 == 0) {
      const Vector3d seam(random.uniform(-corridor.margin, corridor.length + corridor.margin),
                          random.chance(0.5) ? 1.1 : -1.1, random.chance(0.5) ? 0.0 : 2.6);
      direction = (seam - origin).normalized();
    }
    rays.origin_x[lane] = static_cast<float>(origin.x());
    rays.origin_y[lane] = static_cast<float>(origin.y());
    rays.origin_z[lane] = static_cast<float>(origin.z());
    rays.direction_x[lane] = static_cast<float>(direction.x());
    rays.direction_y[lane] = static_cast<float>(direction.y());
    rays.direction_z[lane] = static_cast<float>(direction.z());
  }
}

TEST(RayCaster, NoRayLeavesAClosedCorridorAndNormalsFaceIt) {
  const SceneConfig config = furnished_corridor();
  const CorridorConfig& corridor = config.corridor;
  const RayCaster caster(build_scene(config, kSeed));
  RandomStream random = rng(kSeed, "leaks");
  const double half_width = 0.5 * corridor.width + corridor.doors.depth;
  int leaks = 0;
  int bad_normals = 0;
  RayPacket rays;
  HitPacket hits;
  for (int packet = 0; packet < 70'000; ++packet) {
    fill(rays, corridor, random);
    caster.cast(rays, 1e4F, hits);
    for (int i = 0; i < kRayPacketSize; ++i) {
      const Vector3d direction(rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]);
      const Vector3d point = Vector3d(rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]) +
                             hits.distance[i] * direction;
      const bool inside = point.x() > -corridor.margin - 1e-3 &&
                          point.x() < corridor.length + corridor.margin + 1e-3 &&
                          std::abs(point.y()) < half_width + 1e-3 && point.z() > -1e-3 &&
                          point.z() < corridor.height + 1e-3;
      if (hits.surface[i] < 0 || !inside) ++leaks;
      const Vector3d normal(hits.normal_x[i], hits.normal_y[i], hits.normal_z[i]);
      if (std::abs(normal.norm() - 1.0) > 1e-5 || normal.dot(direction) > 0.0) ++bad_normals;
    }
  }
  EXPECT_EQ(leaks, 0) << "of 1,120,000 rays, seed " << kSeed;
  EXPECT_EQ(bad_normals, 0);
}

TEST(RayCaster, SeesTheFloorsHeights) {
  SceneConfig config;
  config.bumps.height = 0.02;
  const Scene scene = build_scene(config, kSeed);
  const RayCaster caster(scene);
  const Floor& floor = scene.floor;
  const Eigen::Vector2d size = floor.max_corner - floor.min_corner;
  int checked = 0;
  for (int column = 1; column + 1 < floor.columns; column += 7) {
    for (int row = 1; row + 1 < floor.rows; ++row) {
      const double x = floor.min_corner.x() + size.x() * column / (floor.columns - 1);
      const double y = floor.min_corner.y() + size.y() * row / (floor.rows - 1);
      if (std::abs(y) > 1.05 || x < -2.9 || x > 81.5) continue;
      const auto hit = caster.cast({x, y, 1.0}, -Vector3d::UnitZ());
      ASSERT_TRUE(hit);
      EXPECT_EQ(hit->surface, caster.floor_surface());
      EXPECT_NEAR(1.0 - hit->distance, floor.heights[row * floor.columns + column], 1e-4);
      ++checked;
    }
  }
  EXPECT_GT(checked, 500);
}

TEST(RayCaster, SkipsInvisibleSolids) {
  Scene scene;
  Solid wall;
  wall.T_world_solid.translation = Vector3d(3.0, 0.0, 1.0);
  wall.visible = false;
  scene.solids.push_back(wall);
  const RayCaster caster(scene);
  EXPECT_FALSE(caster.cast({0.0, 0.0, 1.0}, Vector3d::UnitX()));
  EXPECT_EQ(caster.materials().size(), 2U);
}

std::ptrdiff_t thread_count() {
  const std::filesystem::directory_iterator tasks("/proc/self/task");
  return std::distance(begin(tasks), end(tasks));
}

TEST(RayCaster, StartsNoThreads) {
  const auto before = thread_count();
  SceneConfig config = furnished_corridor();
  config.bumps.height = 0.02;
  const RayCaster caster(build_scene(config, kSeed));
  EXPECT_EQ(thread_count(), before);
}

}  // namespace
}  // namespace aims
