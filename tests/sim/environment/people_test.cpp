// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/people.hpp"

#include <cmath>

#include "sim/sensors/lidar.hpp"
#include "tests/sim/environment/scene_checks.hpp"

namespace aims {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

SceneConfig with_people(int count) {
  SceneConfig config;
  config.corridor.length = 25.0;
  config.corridor.doors.sides = WallSides::kNone;
  config.people.count = count;
  return config;
}

TEST(Person, WalksUpAndDownAtItsSpeed) {
  Person person;
  person.from = {-2.0, 0.5};
  person.to = {4.0, 0.5};
  person.speed = 1.5;
  person.start = 1.0;
  EXPECT_TRUE(person.position(0).isApprox(Vector2d(-1.0, 0.5), 1e-12));
  EXPECT_TRUE(person.position(2 * kSecond).isApprox(Vector2d(2.0, 0.5), 1e-12));
  EXPECT_TRUE(person.position(4 * kSecond).isApprox(Vector2d(3.0, 0.5), 1e-12))
      << "on its way back";
  EXPECT_TRUE(person.position(8 * kSecond).isApprox(person.position(0), 1e-9)) << "one round";
  Vector2d last = person.position(0);
  for (Time t = 10 * kMillisecond; t < 30 * kSecond; t += 10 * kMillisecond) {
    const Vector2d here = person.position(t);
    ASSERT_LE((here - last).norm(), 0.015 + 1e-9);
    last = here;
  }
}

TEST(IntersectPeople, AgreesWithMarchingAlongTheRay) {
  constexpr std::uint64_t kSeed = 21;
  RandomStream random = rng(kSeed, "rays");
  PeopleConfig config;
  config.count = 1;
  const std::vector<Person> people = people_on({{Stretch{{}, {-2.0, 3.0}}}}, config, 3);
  const Person& person = people.front();
  int met = 0;
  for (int packet = 0; packet < 400; ++packet) {
    RayPacket rays;
    HitPacket hits;
    std::array<Time, kRayPacketSize> stamps;
    const Time start = from_seconds(random.uniform(0.0, 20.0));
    const Vector2d at = person.position(start);
    const Vector3d origin(at.x() + random.uniform(-4.0, 4.0), at.y() + random.uniform(0.4, 4.0),
                          random.uniform(0.1, 2.6));
    const Vector3d aim(at.x() + random.uniform(-0.4, 0.4), at.y(), random.uniform(-0.3, 2.1));
    for (int lane = 0; lane < kRayPacketSize; ++lane) {
      const Vector3d spread = 0.05 * lane * Vector3d(0.2, 0.0, 0.0);
      const Vector3d direction = (aim + spread - origin).normalized();
      rays.origin_x[lane] = static_cast<float>(origin.x());
      rays.origin_y[lane] = static_cast<float>(origin.y());
      rays.origin_z[lane] = static_cast<float>(origin.z());
      rays.direction_x[lane] = static_cast<float>(direction.x());
      rays.direction_y[lane] = static_cast<float>(direction.y());
      rays.direction_z[lane] = static_cast<float>(direction.z());
      hits.distance[lane] = 20.0F;
      hits.surface[lane] = -1;
      stamps[lane] = start + lane * 55'555;
    }
    intersect_people(people, rays, stamps, 100, 20.0F, hits);
    for (int lane = 0; lane < kRayPacketSize; ++lane) {
      const Vector3d direction(rays.direction_x[lane], rays.direction_y[lane],
                               rays.direction_z[lane]);
      const auto inside = [&](double s, double margin) {
        const Vector3d p = origin + s * direction;
        return (p.head<2>() - person.position(stamps[lane])).norm() < person.radius + margin &&
               p.z() > -margin && p.z() < person.height + margin;
      };
      const bool hit = hits.surface[lane] == 100;
      met += hit ? 1 : 0;
      const double until = hit ? hits.distance[lane] - 1e-3 : 12.0;
      for (double s = 0.0; s < until; s += 0.004) {
        ASSERT_FALSE(inside(s, -1e-3)) << "seed " << kSeed << ", packet " << packet;
      }
      if (hit) {
        ASSERT_TRUE(inside(hits.distance[lane], 1e-4));
        const Vector3d normal(hits.normal_x[lane], hits.normal_y[lane], hits.normal_z[lane]);
        ASSERT_NEAR(normal.norm(), 1.0, 1e-5);
        ASSERT_LT(normal.dot(direction), 1e-3);
      }
    }
  }
  EXPECT_GT(met, 1500) << "most rays should meet the person";
}

TEST(IntersectPeople, PacketsAgreeWithSingleRays) {
  PeopleConfig config;
  config.count = 5;
  config.speed = 3.0;
  const std::vector<Person> people = people_on({{Stretch{{}, {-2.0, 3.0}}}}, config, 8);
  int met = 0;
  for (int packet = 0; packet < 200; ++packet) {
    RayPacket rays;
    std::array<Time, kRayPacketSize> stamps;
    for (int lane = 0; lane < kRayPacketSize; ++lane) {
      const double azimuth = 0.031 * packet + 0.39 * lane;  // all around the sensor
      rays.origin_z[lane] = 0.5F;
      rays.direction_x[lane] = static_cast<float>(std::cos(azimuth));
      rays.direction_y[lane] = static_cast<float>(std::sin(azimuth));
      stamps[lane] = packet * 70 * kMillisecond + lane * 6 * kMillisecond;
    }
    HitPacket together;
    together.distance.fill(20.0F);
    together.surface.fill(-1);
    intersect_people(people, rays, stamps, 0, 20.0F, together);
    for (int lane = 0; lane < kRayPacketSize; ++lane) {
      RayPacket alone;
      alone.origin_z.fill(0.5F);
      alone.direction_x.fill(rays.direction_x[lane]);
      alone.direction_y.fill(rays.direction_y[lane]);
      std::array<Time, kRayPacketSize> stamp;
      stamp.fill(stamps[lane]);
      HitPacket single;
      single.distance.fill(20.0F);
      single.surface.fill(-1);
      intersect_people(people, alone, stamp, 0, 20.0F, single);
      ASSERT_EQ(together.surface[lane], single.surface[0]) << packet << " " << lane;
      ASSERT_EQ(together.distance[lane], single.distance[0]);
      met += single.surface[0] >= 0 ? 1 : 0;
    }
  }
  EXPECT_GT(met, 200);
}

TEST(LidarOfPeople, HitsThemAtTheirPositionAtTheTimeOfFiring) {
  SceneConfig config = with_people(8);
  config.people.speed = 3.0;
  const Scene scene = build_scene(config, 2);
  const RayCaster caster(scene);
  LidarConfig lidar_config;
  lidar_config.range_sigma = 0.0;
  lidar_config.body_mask_min = lidar_config.body_mask_max = Vector3d::Zero();
  Lidar lidar(lidar_config, caster, 1);
  int met = 0;
  double stale = 0.0;
  for (int index = 0; index < 10; ++index) {
    const Time start = index * 3 * kSecond;
    const Vector3d sensor(12.0, 0.1, 0.45);
    ScanTruth truth;
    const LidarScan scan = lidar.scan(start, {{start, {so3_exp({0.0, 0.0, 0.3}), sensor}}}, &truth);
    ASSERT_EQ(truth.surfaces.size(), scan.points.size());
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      if (truth.surfaces[i] < caster.first_moving_surface()) continue;
      ++met;
      const Person& person = scene.people.at(truth.surfaces[i] - caster.first_moving_surface());
      const Vector3d point =
          so3_exp({0.0, 0.0, 0.3}) * scan.points[i].position.cast<double>() + sensor;
      const Time fired = start + scan.points[i].time_offset_ns;
      const double radius = (point.head<2>() - person.position(fired)).norm();
      ASSERT_NEAR(radius, person.radius, 1e-4);
      ASSERT_LT(point.z(), person.height + 1e-4);
      const double at_start = (point.head<2>() - person.position(start)).norm();
      stale = std::max(stale, std::abs(at_start - person.radius));
    }
  }
  EXPECT_GT(met, 1000);
  EXPECT_GT(stale, 0.1) << "the scan's start would have been the wrong time";
}

TEST(LidarOfPeople, StandingPeopleLookLikeSolids) {
  SceneConfig config = with_people(6);
  config.people.speed = 0.0;
  const Scene scene = build_scene(config, 5);
  const Scene still = scene_at(scene, 0);
  EXPECT_EQ(still.solids.size(), scene.solids.size() + 6);
  const RayCaster moving(scene);
  const RayCaster fixed(still);
  LidarConfig lidar_config;
  lidar_config.range_sigma = 0.0;
  lidar_config.miss_probability = 0.0;
  lidar_config.range_at_10_percent = 1e4;
  Lidar one(lidar_config, moving, 1);
  Lidar other(lidar_config, fixed, 1);
  const Trajectory pose = {{0, {Eigen::Quaterniond::Identity(), {12.0, 0.0, 0.45}}}};
  const LidarScan a = one.scan(0, pose);
  const LidarScan b = other.scan(0, pose);
  ASSERT_EQ(a.points.size(), b.points.size());
  std::size_t apart = 0;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    // A prism of 48 sides stands for the solid cylinder; its silhouette differs by a millimetre.
    apart += (a.points[i].position - b.points[i].position).norm() > 0.01F ? 1 : 0;
  }
  EXPECT_LT(apart, a.points.size() / 500);
}

TEST(PeopleScene, KeepToLanesBesideTheRobotAndComeFromTheSeed) {
  const auto people = [](std::uint64_t seed) { return build_scene(with_people(12), seed).people; };
  const auto one = people(1);
  const auto again = people(1);
  const auto other = people(2);
  int same = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].start, again[i].start);
    same += one[i].start == other[i].start ? 1 : 0;
    for (Time t = 0; t < 200 * kSecond; t += kSecond) {
      const Vector2d at = one[i].position(t);
      EXPECT_EQ(std::abs(at.y()), 0.75);
      EXPECT_GE(at.x(), -2.0);
      EXPECT_LE(at.x(), 27.0);
    }
  }
  EXPECT_EQ(same, 0);
  EXPECT_TRUE(build_scene(with_people(0), 1).people.empty());
}

/// A scene of each kind with twelve people; the corridor also with a ramp and with bends.
std::vector<SceneConfig> all_kinds() {
  std::vector<SceneConfig> scenes(7);
  scenes[0].kind = SceneKind::kGarage;
  scenes[1].kind = SceneKind::kJunction;
  scenes[2].kind = SceneKind::kTunnel;
  scenes[3].kind = SceneKind::kLoop;
  scenes[4].corridor.length = 25.0;
  scenes[4].ramp = {.start = 8.0, .length = 8.0, .grade = 0.1};
  scenes[5].corridor.bends = {{0.3, 60.0, Side::kLeft}, {0.8, 120.0, Side::kRight}};
  for (SceneConfig& each : scenes) each.people = {.count = 12, .speed = 2.0};
  return scenes;
}

TEST(PeopleScene, OfEveryKindHasPeopleClearOfItsWallsOnItsFloor) {
  for (const SceneConfig& config : all_kinds()) {
    SCOPED_TRACE(static_cast<int>(config.kind));
    ASSERT_TRUE(validate(config)) << validate(config).error().message;
    const Scene scene = build_scene(config, 3);
    ASSERT_EQ(scene.people.size(), 12U);
    for (const Person& person : scene.people) {
      for (Time t = 0; t < 60 * kSecond; t += kSecond / 2) {
        const Vector2d at = person.position(t);
        const double ground = floor_height(scene.floor, at.x(), at.y());
        EXPECT_NEAR(person.ground, ground, 1e-6);
        const Vector3d middle(at.x(), at.y(), ground + 1.0);
        ASSERT_FALSE(is_inside_solid(scene, middle, person.radius - 1e-6)) << at.transpose();
        EXPECT_NEAR((person.position(t + kMillisecond) - at).norm(), 0.002, 1e-4) << "2 m/s";
      }
    }
  }
}

TEST(PeopleScene, OnAnArcKeepTheirDistanceFromTheCentreLine) {
  SceneConfig config;
  config.kind = SceneKind::kTunnel;
  config.tunnel.radius = 10.0;
  config.people = {.count = 6, .speed = 1.5};
  for (const Person& person : build_scene(config, 1).people) {
    EXPECT_GT(std::abs(person.turn), 3.5) << "beyond half a circle";
    for (Time t = 0; t < 80 * kSecond; t += kSecond) {
      const double radius = (person.position(t) - Vector2d(0.0, 10.0)).norm();
      EXPECT_NEAR(std::abs(radius - 10.0), 0.75, 1e-9);
    }
  }
}

/// Beyond a ramp people stand on the upper floor: rays meet them there and pass above and below.
TEST(PeopleScene, OnAnUpperFloorAreMetAtTheirHeight) {
  PeopleConfig config;
  config.count = 1;
  config.speed = 0.0;
  const std::vector<Person> people = people_on({{Stretch{{}, {5.0, 5.5}, 0.0, 0.8}}}, config, 1);
  const Vector2d at = people[0].position(0);
  RayPacket rays;
  HitPacket hits;
  hits.distance.fill(20.0F);
  hits.surface.fill(-1);
  std::array<Time, kRayPacketSize> stamps{};
  for (int lane = 0; lane < kRayPacketSize; ++lane) {
    rays.origin_y[lane] = static_cast<float>(at.y());
    rays.origin_z[lane] = 0.2F * static_cast<float>(lane);
    rays.direction_x[lane] = 1.0F;
  }
  intersect_people(people, rays, stamps, 0, 20.0F, hits);
  for (int lane = 0; lane < kRayPacketSize; ++lane) {
    const double z = 0.2 * lane;
    if (std::abs(z - 0.8) < 0.01) continue;  // the edge
    EXPECT_EQ(hits.surface[lane] >= 0, z > 0.8 && z < 0.8 + 1.75) << z;
  }
  EXPECT_NEAR(scene_at({{}, {}, people}, 0).solids[0].T_world_solid.translation.z(),
              0.8 + 0.5 * 1.75, 1e-12);
}

TEST(PeopleScene, WithoutALevelStretchIsRefused) {
  SceneConfig config;
  config.kind = SceneKind::kLoop;
  config.loop.length = config.loop.depth = 4.2;
  config.people.count = 1;
  ASSERT_TRUE(validate(config)) << "short sides have room";
  config.kind = SceneKind::kCorridor;
  config.corridor.length = 6.0;
  config.corridor.margin = 1.0;
  config.ramp = {.start = 0.5, .length = 6.4, .grade = 0.1};
  const auto refused = validate(config);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("scene.people.count: expected 0"), std::string::npos)
      << refused.error().message;
}

TEST(PeopleScene, LanesThroughWallsOrRobotAreRefused) {
  SceneConfig config = with_people(1);
  config.people.lane_offset = 0.9;
  EXPECT_NE(validate(config).error().message.find("scene.people.lane_offset"), std::string::npos);
  config.people.lane_offset = 0.5;
  EXPECT_NE(validate(config).error().message.find("scene.people.lane_offset"), std::string::npos);
  config.people.lane_offset = 0.75;
  EXPECT_TRUE(validate(config));
}

}  // namespace
}  // namespace aims
