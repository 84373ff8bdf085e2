// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/dynamic_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "estimator/lidar/range_image.hpp"

namespace aims {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kHalfWidth = 1.1;  // of the corridor [m]
constexpr double kSensorHeight = 0.5;
const Eigen::Vector3d kLever(0.2, 0.0, 0.1);

/// An upright cylinder that walks along the corridor.
struct Walker {
  double x = 0.0;  ///< at time 0 [m]
  double y = 0.0;
  double speed = 0.0;  ///< [m/s]
  double distance(const Eigen::Vector3d& from, const Eigen::Vector3d& ray, double time) const {
    const Eigen::Vector2d to(x + speed * time - from.x(), y - from.y());
    const double a = ray.head<2>().squaredNorm();
    const double b = to.dot(ray.head<2>());
    const double root = b * b - a * (to.squaredNorm() - 0.25 * 0.25);
    if (root < 0.0 || b < 0.0) return kNone;
    const double s = (b - std::sqrt(root)) / a;
    const double z = from.z() + s * ray.z();
    return z >= 0.0 && z <= 1.75 ? s : kNone;
  }
};

/// Distance to the plane where coordinate `axis` is `at`.
double to_plane(const Eigen::Vector3d& from, const Eigen::Vector3d& ray, int axis, double at) {
  const double s = (at - from(axis)) / ray(axis);
  return s > 0.0 ? s : kNone;
}

/// A corridor with an end, a recess 1 m deep from x = 3 to 4 m, and a pillar at x = 6 m.
double corridor(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
  double s = std::min({to_plane(from, ray, 2, 0.0), to_plane(from, ray, 2, 2.6),
                       to_plane(from, ray, 0, 14.0), to_plane(from, ray, 0, -14.0),
                       to_plane(from, ray, 1, -kHalfWidth)});
  double left = to_plane(from, ray, 1, kHalfWidth);
  const double x = from.x() + left * ray.x();
  if (x > 3.0 && x < 4.0) {
    left = std::min(to_plane(from, ray, 1, kHalfWidth + 1.0),
                    to_plane(from, ray, 0, ray.x() > 0.0 ? 4.0 : 3.0));
  }
  s = std::min(s, left);
  const double pillar = to_plane(from, ray, 0, 6.0);
  if (ray.x() > 0.0 && pillar < s && from.y() + pillar * ray.y() > 0.8) s = pillar;
  return s;
}

PointBlocks blocks_of(const std::vector<Eigen::Vector3f>& points) {
  PointBlocks blocks;
  for (const Eigen::Vector3f& point : points) blocks.push_back(point);
  return blocks;
}

bool passed(const RangeImage& image, const Eigen::Vector3f& point, float margin) {
  return (image.passed(blocks_of({point}).block(0), margin) & 1U) != 0;
}

struct Seen {
  std::vector<Eigen::Vector3f> person;  ///< in body axes
  std::vector<Eigen::Vector3f> rest;
  std::vector<Eigen::Vector3f> all;
};

/// A scan of 16 rings from a pose of the body.
Seen scan_at(const Pose& T_world_body, const std::optional<Walker>& walker, double time) {
  Seen seen;
  const Eigen::Vector3d from = T_world_body * kLever;
  for (int column = 0; column < 900; ++column) {
    const double azimuth = (column + 0.5) * 2.0 * std::numbers::pi / 900.0;
    for (int ring = 0; ring < 16; ++ring) {
      const double elevation = (-15.0 + 2.0 * ring) * std::numbers::pi / 180.0;
      const Eigen::Vector3d beam(std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const Eigen::Vector3d ray = T_world_body.R() * beam;
      const double wall = corridor(from, ray);
      const double person = walker ? walker->distance(from, ray, time) : kNone;
      const Eigen::Vector3f point = (std::min(wall, person) * beam + kLever).cast<float>();
      seen.all.push_back(point);
      (person < wall ? seen.person : seen.rest).push_back(point);
    }
  }
  return seen;
}

/// The body walks ahead at 0.7 m/s and pitches.
Pose body_at(double time) {
  Pose pose;
  const double pitch = 0.03 * std::sin(9.0 * time);
  pose.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()));
  pose.translation = {0.7 * time, 0.0, kSensorHeight - kLever.z()};
  return pose;
}

/// Fractions of returns left out.
struct LeftOut {
  double person = 0.0;
  double rest = 0.0;
};

/// Of the scan after `scans` earlier ones, 0.1 s apart.
LeftOut left_out_after(int scans, const std::optional<Walker>& walker) {
  DynamicPoints moving(kLever);
  for (int scan = 0;; ++scan) {
    const double time = 0.1 * scan;
    const Pose pose = body_at(time);
    Seen seen = scan_at(pose, walker, time);
    moving.compare(blocks_of(seen.all), from_seconds(time), pose);
    if (scan < scans) {
      moving.keep(pose);
      continue;
    }
    const auto fraction = [&](std::vector<Eigen::Vector3f>& points) {
      const auto count = static_cast<double>(points.size());
      return count > 0.0 ? moving.remove_from(points) / count : 0.0;
    };
    return {fraction(seen.person), fraction(seen.rest)};
  }
}

TEST(DynamicPoints, LeavesOutNothingWhereNothingMoves) {
  for (int scans = 0; scans < 30; ++scans) {
    EXPECT_EQ(left_out_after(scans, {}).rest, 0.0) << "scan " << scans;
  }
}

TEST(DynamicPoints, LeavesOutPeopleInWhateverDirectionTheyWalk) {
  for (const double speed : {-1.2, 1.2, 0.6}) {
    for (const double x : {3.0, 4.5, 6.0}) {
      const LeftOut left_out = left_out_after(15, Walker{x, -0.75, speed});
      EXPECT_GT(left_out.person, 0.9) << speed << " m/s from " << x;
      EXPECT_LT(left_out.rest, 0.15) << speed << " m/s from " << x;
    }
  }
}

TEST(DynamicPoints, KeepsThoseWhoStand) {
  const LeftOut left_out = left_out_after(15, Walker{4.5, -0.75, 0.0});
  EXPECT_EQ(left_out.person, 0.0);
  EXPECT_EQ(left_out.rest, 0.0);
}

TEST(DynamicPoints, NeedsAScanFromHalfASecondBefore) {
  const Walker walker{4.5, -0.75, -1.2};
  EXPECT_EQ(left_out_after(4, walker).person, 0.0);
  EXPECT_GT(left_out_after(6, walker).person, 0.5);
}

// The pose of a scan is known better after its update than when it is compared.
TEST(DynamicPoints, ComparesWithScansAtTheirCorrectedPoses) {
  DynamicPoints moving(kLever);
  for (int scan = 0; scan < 12; ++scan) {
    const double time = 0.1 * scan;
    Seen seen = scan_at(body_at(time), {}, time);
    Pose predicted = body_at(time);
    if (scan < 11) predicted.translation.y() += 1.0;
    moving.compare(blocks_of(seen.all), from_seconds(time), predicted);
    if (scan == 11) {
      EXPECT_EQ(moving.remove_from(seen.all), 0);
    }
    moving.keep(body_at(time));
  }
}

/// Points on the plane y = 1 before the sensor, 0.5 deg apart.
std::vector<Eigen::Vector3f> wall_beside() {
  std::vector<Eigen::Vector3f> points;
  for (double azimuth = 0.02; azimuth < 3.12; azimuth += 0.5 / 57.3) {
    for (double slope = -0.5; slope < 0.5; slope += 0.02) {
      const Eigen::Vector3d ray(std::cos(azimuth), std::sin(azimuth), slope);
      points.push_back((ray / std::sin(azimuth)).cast<float>());
    }
  }
  return points;
}

TEST(RangeImage, WallAtGrazingIncidenceIsNotPassed) {
  RangeImage image;
  const auto points = wall_beside();
  image.fill(blocks_of(points));
  for (const Eigen::Vector3f& point : points) {
    EXPECT_FALSE(passed(image, point, 0.05F));
  }
  EXPECT_TRUE(passed(image, {0.0F, 0.5F, 0.0F}, 0.3F));
  EXPECT_FALSE(passed(image, {0.0F, 0.5F, 0.0F}, 0.6F));
  EXPECT_FALSE(passed(image, {0.0F, -0.5F, 0.0F}, 0.1F)) << "no return from there";
  EXPECT_FALSE(image.confirms({0.0F, 0.5F, 0.0F}, 0.3F));
}

// Azimuth jumps from 180 to -180 deg there.
TEST(RangeImage, IsClosedBehindTheSensor) {
  std::vector<Eigen::Vector3f> points;
  for (float y = -1.0F; y < 1.0F; y += 0.02F) {
    for (float z = -1.0F; z < 1.0F; z += 0.02F) points.emplace_back(-4.0F, y, z);
  }
  RangeImage image;
  image.fill(blocks_of(points));
  for (const float y : {-0.01F, 0.01F}) {
    EXPECT_TRUE(passed(image, {-3.0F, y, 0.0F}, 0.5F));
    EXPECT_TRUE(image.confirms({-4.0F, y, 0.0F}, 0.1F));
  }
}

}  // namespace
}  // namespace aims
