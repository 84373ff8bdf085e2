// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/lidar.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>

#include "sim/environment/scene_config.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;

/// A sensor without noise that sees everything.
LidarConfig perfect() {
  LidarConfig config;
  config.range_sigma = 0.0;
  config.miss_probability = 0.0;
  config.range_at_10_percent = 1e4;
  config.body_mask_min = config.body_mask_max = Vector3d::Zero();
  return config;
}

Scene plain_corridor() {
  SceneConfig config;
  config.corridor.doors.sides = WallSides::kNone;
  return build_scene(config, 1);
}

/// One large facing wall at x = `distance` and nothing else in reach.
Scene wall_at(double distance, double reflectivity) {
  Scene scene;
  Solid wall;
  wall.T_world_solid.translation = {distance + 0.5, 0.0, 0.0};
  wall.half_extents = {0.5, 1000.0, 1000.0};
  wall.material.reflectivity = reflectivity;
  scene.solids.push_back(wall);
  scene.floor.min_corner = {-1000.0, 0.0};
  scene.floor.max_corner = {-999.0, 1.0};
  return scene;
}

/// Poses of a sensor that moves and turns hard, sampled every 2.5 ms.
Trajectory rough_motion() {
  Trajectory poses;
  for (int i = 0; i <= 41; ++i) {
    const double t = 0.0025 * i;
    const Vector3d rotation(0.1 * std::sin(20.0 * t), 0.08 * std::cos(25.0 * t), 2.0 * t);
    const Vector3d position(40.0 + 1.5 * t, 0.1 * std::sin(9.0 * t),
                            0.45 + 0.02 * std::sin(30 * t));
    poses.push_back({kSecond + from_seconds(t), {so3_exp(rotation), position}});
  }
  return poses;
}

Trajectory still(const Vector3d& position = {40.0, 0.0, 0.45}) {
  return {{0, {Eigen::Quaterniond::Identity(), position}}};
}

/// One scan of a new LiDAR.
LidarScan one_scan(const Scene& scene, const LidarConfig& config, const Trajectory& poses,
                   std::uint64_t seed = 1) {
  const RayCaster caster(scene);
  return Lidar(config, caster, seed).scan(poses.front().stamp, poses);
}

/// Distance of a point from the nearest face of the plain corridor.
double off_surface(const Vector3d& p) {
  return std::min({std::abs(std::abs(p.y()) - 1.1), std::abs(p.z()), std::abs(p.z() - 2.6),
                   std::abs(p.x() + 3.0), std::abs(p.x() - 81.6)});
}

TEST(Lidar, PointsSeenFromTheirOwnFiringsLieOnTheSurfaces) {
  const Trajectory poses = rough_motion();
  const LidarScan scan = one_scan(plain_corridor(), perfect(), poses);
  EXPECT_EQ(scan.points.size(), 28'800U);
  double worst = 0.0;
  double worst_frozen = 0.0;
  for (const LidarPoint& point : scan.points) {
    const auto pose = pose_at(poses, scan.stamp + point.time_offset_ns);
    ASSERT_TRUE(pose);
    worst = std::max(worst, off_surface(*pose * point.position.cast<double>()));
    worst_frozen =
        std::max(worst_frozen, off_surface(poses[0].pose * point.position.cast<double>()));
  }
  EXPECT_LT(worst, 1e-3);
  EXPECT_GT(worst_frozen, 0.2) << "the motion within the scan matters";
}

TEST(Lidar, FiresColumnByColumnFromTheLowestRingUpClockwise) {
  const LidarScan scan = one_scan(plain_corridor(), perfect(), still());
  ASSERT_EQ(scan.points.size(), 28'800U);
  EXPECT_EQ(scan.stamp, 0);
  EXPECT_EQ(scan.end, 100 * kMillisecond);
  double azimuth_before = 10.0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const LidarPoint& point = scan.points[i];
    ASSERT_EQ(point.ring, i % 16);
    if (i > 0) {
      ASSERT_GE(point.time_offset_ns, scan.points[i - 1].time_offset_ns);
    }
    const Vector3d direction = point.position.cast<double>().normalized();
    const double elevation = std::asin(direction.z()) * 180.0 / std::numbers::pi;
    ASSERT_NEAR(elevation, -15.0 + 2.0 * point.ring, 1e-3);
    if (i % 1600 == 800) {
      const double azimuth = std::atan2(direction.y(), direction.x());
      EXPECT_LT(wrap_angle(azimuth - azimuth_before), 0.0);
      azimuth_before = azimuth;
    }
  }
  EXPECT_LT(scan.points.back().time_offset_ns, 100 * kMillisecond);
  EXPECT_GT(scan.points.back().time_offset_ns, 99 * kMillisecond);
}

TEST(Lidar, TimesAreThoseThatFloat32SecondsHold) {
  const LidarScan scan = one_scan(plain_corridor(), perfect(), still());
  const double column_ns = 1e8 / 1800.0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const std::int32_t offset = scan.points[i].time_offset_ns;
    const auto seconds = static_cast<float>(offset * 1e-9);
    ASSERT_EQ(std::llround(static_cast<double>(seconds) * 1e9), offset) << i;
    const double fired =
        static_cast<double>(i / 16) * column_ns + static_cast<double>(i % 16) * 2304.0;
    ASSERT_NEAR(offset, fired, 4.3) << "half of the float's spacing at 0.1 s";
  }
}

TEST(Lidar, FiringsOfEveryPatternLeaveFromTheirOwnPoses) {
  LidarConfig table = perfect();
  table.column_interval_us = 55.296;
  table.table.elevations_deg = {-15.0, 1.0, -13.0, 3.0};
  table.table.azimuth_offsets_deg = {1.4, -4.2, 4.2, -1.4};
  table.table.firing_delays_us = {0.0, 2.304, 4.608, 6.912};
  LidarConfig rosette = perfect();
  rosette.pattern = LidarPattern::kRosette;
  rosette.rosette = {.point_rate = 2e5,
                     .prism_deflections_deg = {67.5, 26.5},
                     .prism_rates = {-182.43, -172.71},
                     .line_offsets_deg = {-3.0, -1.0, 1.0, 3.0}};
  const Trajectory poses = rough_motion();
  for (const LidarConfig& config : {table, rosette}) {
    const LidarScan scan = one_scan(plain_corridor(), config, poses);
    ASSERT_EQ(scan.points.size(), ScanPattern(config).firings(10).size()) << "the scan of 1 s";
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const LidarPoint& point = scan.points[i];
      if (i > 0) {
        ASSERT_GE(point.time_offset_ns, scan.points[i - 1].time_offset_ns);
      }
      const auto pose = pose_at(poses, scan.stamp + point.time_offset_ns);
      ASSERT_TRUE(pose);
      ASSERT_LT(off_surface(*pose * point.position.cast<double>()), 1e-3);
    }
  }
}

TEST(Lidar, AnglesHaveTheConfiguredNoiseAcrossAndUp) {
  LidarConfig config = perfect();
  const LidarScan exact = one_scan(plain_corridor(), config, still());
  config.direction_sigma_deg = 0.15;
  const LidarScan noisy = one_scan(plain_corridor(), config, still());
  ASSERT_EQ(exact.points.size(), noisy.points.size());
  double across = 0.0;
  double up = 0.0;
  for (std::size_t i = 0; i < exact.points.size(); ++i) {
    const Vector3d beam = exact.points[i].position.cast<double>().normalized();
    const Vector3d turned = noisy.points[i].position.cast<double>().normalized();
    const Vector3d sideways = Vector3d::UnitZ().cross(beam).normalized();
    across += std::pow(turned.dot(sideways), 2);
    up += std::pow(turned.dot(beam.cross(sideways)), 2);
    ASSERT_NEAR(exact.points[i].position.norm(), noisy.points[i].position.norm(), 1e-4);
  }
  const auto count = static_cast<double>(exact.points.size());
  const double sigma = 0.15 * std::numbers::pi / 180.0;
  EXPECT_NEAR(std::sqrt(across / count), sigma, 0.02 * sigma);
  EXPECT_NEAR(std::sqrt(up / count), sigma, 0.02 * sigma);
}

TEST(Lidar, ColumnsNeedNotFillTheLastPacket) {
  LidarConfig config = perfect();
  config.columns = 1000 + 7;
  config.rings = 5;
  const LidarScan scan = one_scan(plain_corridor(), config, still());
  EXPECT_EQ(scan.points.size(), 5U * 1007U);
}

TEST(Lidar, RangeNoiseHasTheConfiguredSigma) {
  LidarConfig config = perfect();
  const LidarScan exact = one_scan(plain_corridor(), config, still());
  config.range_sigma = 0.02;
  const LidarScan noisy = one_scan(plain_corridor(), config, still());
  ASSERT_EQ(exact.points.size(), noisy.points.size());
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < exact.points.size(); ++i) {
    const double error = noisy.points[i].position.norm() - exact.points[i].position.norm();
    sum += error;
    squares += error * error;
  }
  const double n = static_cast<double>(exact.points.size());
  EXPECT_NEAR(sum / n, 0.0, 4.0 * 0.02 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), 0.02, 4.0 * 0.02 / std::sqrt(2.0 * n));
}

TEST(Lidar, DropsWhatIsTooNearOrTooFar) {
  LidarConfig config = perfect();
  config.range_sigma = 0.02;
  config.range_min = 1.2;
  config.range_max = 8.0;
  const LidarScan scan = one_scan(plain_corridor(), config, still());
  ASSERT_GT(scan.points.size(), 10'000U);
  const auto range = [](const LidarPoint& point) { return point.position.norm(); };
  for (const LidarPoint& point : scan.points) {
    ASSERT_TRUE(point.position.allFinite());
    ASSERT_GE(range(point), 1.2F - 1e-6F);
    ASSERT_LE(range(point), 8.0F + 1e-6F);
  }
}

TEST(Lidar, MissesTheConfiguredFractionAtRandom) {
  LidarConfig config = perfect();
  config.miss_probability = 0.05;
  const double points =
      static_cast<double>(one_scan(plain_corridor(), config, still()).points.size());
  EXPECT_NEAR(points, 0.95 * 28'800, 4.0 * std::sqrt(28'800 * 0.05 * 0.95));
}

TEST(Lidar, SeesNothingInTheOpen) {
  Scene scene = wall_at(500.0, 0.5);
  EXPECT_TRUE(one_scan(scene, perfect(), still(Vector3d::Zero())).points.empty());
}

TEST(LidarDetection, FallsWithRangeAndIncidenceAndRisesWithReflectivity) {
  const LidarConfig config;
  for (double range = 1.0; range < 120.0; range += 0.5) {
    for (double cosine = 0.01; cosine < 0.99; cosine += 0.02) {
      const double here = detection_probability(config, 0.4, cosine, range);
      ASSERT_GE(here, 0.0);
      ASSERT_LE(here, 1.0);
      ASSERT_LE(here, detection_probability(config, 0.4, cosine + 0.02, range));
      ASSERT_GE(here, detection_probability(config, 0.4, cosine, range + 0.5));
      ASSERT_LE(here, detection_probability(config, 0.5, cosine, range));
    }
  }
}

TEST(LidarDetection, HalfTheReturnsOfAFacingTenPercentTargetAreSeenAtItsRange) {
  const LidarConfig config;
  EXPECT_DOUBLE_EQ(detection_probability(config, 0.1, 1.0, config.range_at_10_percent), 0.5);
  LidarConfig narrow = perfect();
  narrow.range_at_10_percent = 30.0;
  narrow.rings = 3;
  narrow.elevation_min_deg = -0.1;
  narrow.elevation_max_deg = 0.1;
  const LidarScan scan = one_scan(wall_at(30.0, 0.1), narrow, still(Vector3d::Zero()));
  int ahead = 0;
  for (const LidarPoint& point : scan.points) {
    if (std::abs(point.position.y()) < 30.0 * std::tan(0.05)) ++ahead;
  }
  const double beams = 3.0 * 1800.0 * 0.1 / (2.0 * std::numbers::pi);
  EXPECT_NEAR(ahead / beams, 0.5, 4.0 * std::sqrt(0.25 / beams) + 0.02);
}

TEST(LidarDetection, GrazingWallsVanishBeforeTheEndWall) {
  LidarConfig config;
  config.range_sigma = 0.0;
  const LidarScan scan = one_scan(plain_corridor(), config, still());
  double farthest_on_wall = 0.0;
  double farthest = 0.0;
  for (const LidarPoint& point : scan.points) {
    const Vector3d p = point.position.cast<double>();
    if (std::abs(std::abs(p.y()) - 1.1) < 1e-3) {
      farthest_on_wall = std::max(farthest_on_wall, std::abs(p.x()));
    }
    farthest = std::max(farthest, std::abs(p.x()));
  }
  EXPECT_NEAR(farthest, 43.0, 0.1) << "the start wall, 43 m behind";
  EXPECT_LT(farthest_on_wall, 36.0);
  EXPECT_GT(farthest_on_wall, 18.0);
}

TEST(Lidar, StrengthIsReflectivityTimesCosineOfIncidence) {
  const LidarScan scan = one_scan(plain_corridor(), perfect(), still());
  int checked = 0;
  for (const LidarPoint& point : scan.points) {
    const Vector3d p = point.position.cast<double>();
    ASSERT_GE(point.intensity, 0.0F);
    ASSERT_LE(point.intensity, 1.0F);
    if (std::abs(std::abs(p.y()) - 1.1) > 1e-4 || std::abs(p.x()) > 30.0) continue;
    EXPECT_NEAR(point.intensity, 0.5 * 1.1 / p.norm(), 1e-3);
    ++checked;
  }
  EXPECT_GT(checked, 10'000);
}

TEST(Lidar, BeamsInTheBodyMaskReturnNothing) {
  LidarConfig config = perfect();
  const std::size_t open = one_scan(plain_corridor(), config, still()).points.size();
  config.body_mask_min = LidarConfig().body_mask_min;
  config.body_mask_max = LidarConfig().body_mask_max;
  const LidarScan scan = one_scan(plain_corridor(), config, still());
  EXPECT_LT(scan.points.size(), open);
  EXPECT_GT(scan.points.size(), open * 9 / 10);
  for (const LidarPoint& point : scan.points) {
    // No point of the beam is inside the box, found by walking along it.
    const Vector3d end = point.position.cast<double>();
    for (double along = 0.0; along < 1.5; along += 0.02) {
      const Vector3d p = along * end.normalized();
      ASSERT_FALSE((p.array() > config.body_mask_min.array() + 1e-3).all() &&
                   (p.array() < config.body_mask_max.array() - 1e-3).all());
    }
  }
}

TEST(Lidar, TruthGoesWithEveryPoint) {
  const Scene scene = plain_corridor();
  const RayCaster caster(scene);
  Lidar lidar(LidarConfig{}, caster, 1);
  ScanTruth truth;
  const LidarScan scan = lidar.scan(0, still(), &truth);
  ASSERT_EQ(truth.normals.size(), scan.points.size());
  ASSERT_EQ(truth.surfaces.size(), scan.points.size());
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    ASSERT_NEAR(truth.normals[i].norm(), 1.0F, 1e-5F);
    ASSERT_LT(truth.normals[i].dot(scan.points[i].position), 0.0F);
    if (truth.surfaces[i] == caster.floor_surface()) {
      ASSERT_GT(truth.normals[i].z(), 0.999F);
      ASSERT_NEAR(scan.points[i].position.z(), -0.45F, 0.1F);
    }
  }
}

bool same(const LidarScan& a, const LidarScan& b) {
  return std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                    [](const LidarPoint& one, const LidarPoint& other) {
                      return one.position == other.position && one.intensity == other.intensity &&
                             one.time_offset_ns == other.time_offset_ns && one.ring == other.ring;
                    });
}

TEST(Lidar, RepeatsBitForBitWithItsSeedAndOnlyWithIt) {
  const Trajectory poses = rough_motion();
  const LidarConfig config;
  EXPECT_TRUE(same(one_scan(plain_corridor(), config, poses, 5),
                   one_scan(plain_corridor(), config, poses, 5)));
  EXPECT_FALSE(same(one_scan(plain_corridor(), config, poses, 5),
                    one_scan(plain_corridor(), config, poses, 6)));
}

TEST(LidarConfig, EveryParameterTakesItsOwnText) {
  LidarConfig config;
  const Fields fields = fields_of(config);
  EXPECT_EQ(fields.parameters().size(), 47U);
  for (const Parameter& each : fields.parameters()) {
    EXPECT_TRUE(each.assign(each.text())) << each.key << " = " << each.text();
  }
}

TEST(LidarConfig, RejectsLimitsInTheWrongOrder) {
  LidarConfig config;
  EXPECT_TRUE(validate(config));
  config.range_max = 0.2;
  EXPECT_FALSE(validate(config));
  config = {};
  config.elevation_max_deg = -20.0;
  EXPECT_FALSE(validate(config));
}

TEST(Lidar, DeadRingsAreTheConfiguredFractionAndConstantInARun) {
  const Scene scene = plain_corridor();
  const RayCaster caster(scene);
  LidarConfig config = perfect();
  config.defects.dead_ring_fraction = 0.25;
  Lidar lidar(config, caster, 3);
  const auto rings_of = [&](Time start) {
    std::set<int> rings;
    const LidarScan scan = lidar.scan(start, still());
    for (const LidarPoint& point : scan.points) rings.insert(point.ring);
    return rings;
  };
  const std::set<int> first = rings_of(0);
  EXPECT_EQ(first.size(), 12U);
  EXPECT_EQ(rings_of(kSecond), first);
  config.defects.dead_ring_fraction = 1.0;
  EXPECT_TRUE(one_scan(scene, config, still()).points.empty());
}

TEST(Lidar, ABlockedSectorReturnsNothingAndTheRestIsUnchanged) {
  LidarConfig config = perfect();
  const LidarScan whole = one_scan(plain_corridor(), config, still());
  config.defects.blocked_sector_center_deg = 170.0;  // reaches over the seam at 180 degrees
  config.defects.blocked_sector_width_deg = 60.0;
  const LidarScan rest = one_scan(plain_corridor(), config, still());
  std::vector<LidarPoint> kept;
  for (const LidarPoint& point : whole.points) {
    const double azimuth = std::atan2(point.position.y(), point.position.x());
    const double off =
        std::remainder(azimuth - 170.0 * std::numbers::pi / 180.0, 2.0 * std::numbers::pi);
    if (std::abs(off) > 30.0 * std::numbers::pi / 180.0 - 1e-5) kept.push_back(point);
  }
  ASSERT_NEAR(static_cast<double>(rest.points.size()), static_cast<double>(kept.size()), 32.0);
  EXPECT_LT(rest.points.size(), whole.points.size() * 0.86);
  for (const LidarPoint& point : rest.points) {
    const double azimuth = std::atan2(point.position.y(), point.position.x());
    const double off =
        std::remainder(azimuth - 170.0 * std::numbers::pi / 180.0, 2.0 * std::numbers::pi);
    EXPECT_GE(std::abs(off), 30.0 * std::numbers::pi / 180.0 - 1e-5);
  }
}

}  // namespace
}  // namespace aims
