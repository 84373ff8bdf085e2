// SPDX-License-Identifier: BSD-3-Clause
// Which firings of a LiDAR return, with which range and strength.
#include "sim/sensors/lidar.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "tests/sim/sensors/lidar_scans.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;
using testing::flawless_lidar;
using testing::one_scan;
using testing::plain_corridor;
using testing::still;

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

TEST(Lidar, RangeNoiseHasTheConfiguredSigma) {
  LidarConfig config = flawless_lidar();
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
  LidarConfig config = flawless_lidar();
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
  LidarConfig config = flawless_lidar();
  config.miss_probability = 0.05;
  const double points =
      static_cast<double>(one_scan(plain_corridor(), config, still()).points.size());
  EXPECT_NEAR(points, 0.95 * 28'800, 4.0 * std::sqrt(28'800 * 0.05 * 0.95));
}

TEST(Lidar, SeesNothingInTheOpen) {
  Scene scene = wall_at(500.0, 0.5);
  EXPECT_TRUE(one_scan(scene, flawless_lidar(), still(Vector3d::Zero())).points.empty());
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
  LidarConfig narrow = flawless_lidar();
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
  const LidarScan scan = one_scan(plain_corridor(), flawless_lidar(), still());
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
  LidarConfig config = flawless_lidar();
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

TEST(Lidar, DeadRingsAreTheConfiguredFractionAndConstantInARun) {
  const Scene scene = plain_corridor();
  const RayCaster caster(scene);
  LidarConfig config = flawless_lidar();
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
  LidarConfig config = flawless_lidar();
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
