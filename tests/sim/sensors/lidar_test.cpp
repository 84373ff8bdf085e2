// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/lidar.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/sim/sensors/lidar_scans.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;
using testing::flawless_lidar;
using testing::one_scan;
using testing::plain_corridor;
using testing::still;

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

/// Distance of a point from the nearest face of the plain corridor.
double off_surface(const Vector3d& p) {
  return std::min({std::abs(std::abs(p.y()) - 1.1), std::abs(p.z()), std::abs(p.z() - 2.6),
                   std::abs(p.x() + 3.0), std::abs(p.x() - 81.6)});
}

TEST(Lidar, PointsSeenFromTheirOwnFiringsLieOnTheSurfaces) {
  const Trajectory poses = rough_motion();
  const LidarScan scan = one_scan(plain_corridor(), flawless_lidar(), poses);
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
  const LidarScan scan = one_scan(plain_corridor(), flawless_lidar(), still());
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
  const LidarScan scan = one_scan(plain_corridor(), flawless_lidar(), still());
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
  LidarConfig table = flawless_lidar();
  table.column_interval_us = 55.296;
  table.table.elevations_deg = {-15.0, 1.0, -13.0, 3.0};
  table.table.azimuth_offsets_deg = {1.4, -4.2, 4.2, -1.4};
  table.table.firing_delays_us = {0.0, 2.304, 4.608, 6.912};
  LidarConfig rosette = flawless_lidar();
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
  LidarConfig config = flawless_lidar();
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
  LidarConfig config = flawless_lidar();
  config.columns = 1000 + 7;
  config.rings = 5;
  const LidarScan scan = one_scan(plain_corridor(), config, still());
  EXPECT_EQ(scan.points.size(), 5U * 1007U);
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

}  // namespace
}  // namespace aims
