// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/mixed_pixel_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/random.hpp"

namespace aims {
namespace {

constexpr int kColumns = 900;
constexpr double kStep = 0.0035;  // between firings [rad]
constexpr double kWall = 1.1;     // beside the sensor [m]

/// Range at an azimuth from the direction of a corridor [m].
using Profile = std::function<double(double)>;

/// A wall beside the sensor, with a recess of `depth` [m] between 3 and 4 m ahead.
Profile wall_with_recess(double depth) {
  return [depth](double azimuth) {
    const double wall = kWall / std::sin(azimuth);
    const double ahead = kWall / std::tan(azimuth);
    if (ahead < 3.0 || ahead > 4.0) return wall;
    const double floor = (kWall + depth) / std::sin(azimuth);
    return std::min(floor, 4.0 / std::cos(azimuth));
  };
}

struct ProfileScan {
  LidarScan scan;
  std::vector<double> azimuth;  ///< of each return [rad]
};

/// Rings that all see the profile, fired column by column, with range noise.
ProfileScan scan_of(const Profile& profile, double noise, int rings, RandomStream& random) {
  ProfileScan result;
  for (int column = 0; column < kColumns; ++column) {
    const double azimuth = 0.05 + kStep * column;
    if (azimuth > 3.0) break;
    for (int ring = 0; ring < rings; ++ring) {
      const double range = profile(azimuth) + noise * random.normal();
      const Eigen::Vector3d p(range * std::cos(azimuth), range * std::sin(azimuth), 0.0);
      result.scan.points.push_back(
          {p.cast<float>(), 0.5F, 55000 * column + ring, static_cast<std::uint16_t>(ring)});
      result.azimuth.push_back(azimuth);
    }
  }
  return result;
}

/// What is marked of a scan.
struct Marks {
  explicit Marks(const LidarScan& scan) : marked(scan.points.size(), false) {
    MixedPixelFilter steps;
    steps.mark(scan);
    for (std::size_t i = 0; i < scan.points.size(); ++i) marked[i] = steps.marked(i);
    range_noise = steps.range_noise();
  }
  auto count() const { return std::ranges::count(marked, true); }

  std::vector<bool> marked;  ///< by the index of the return
  double range_noise = 0.0;
};

// The far side of a recess meets its back and the wall at corners. It constrains the direction of
// the corridor and has to stay.
TEST(MixedPixelFilter, LeavesCornersAlone) {
  RandomStream random(2, "range_steps.test");
  const auto room = [](double azimuth) {  // walls beside and 2 m ahead
    return std::min(kWall / std::sin(azimuth), azimuth < 1.5 ? 2.0 / std::cos(azimuth) : 1e9);
  };
  for (const double noise : {0.0, 0.005, 0.02}) {
    const ProfileScan seen = scan_of(room, noise, 16, random);
    const Marks marks(seen.scan);
    EXPECT_LE(marks.count(), 2) << "noise " << noise;
  }
}

TEST(MixedPixelFilter, MeasuresTheRangeNoiseOfTheScan) {
  RandomStream random(3, "range_steps.test");
  for (const double noise : {0.005, 0.02, 0.1}) {
    const ProfileScan seen = scan_of(wall_with_recess(0.3), noise, 16, random);
    const Marks marks(seen.scan);
    EXPECT_NEAR(marks.range_noise, noise, 0.1 * noise);
  }
}

TEST(MixedPixelFilter, TakesNoiseForNoStep) {
  RandomStream random(4, "range_steps.test");
  for (const double noise : {0.005, 0.02, 0.1}) {
    const ProfileScan seen = scan_of(wall_with_recess(0.0), noise, 16, random);
    const Marks marks(seen.scan);
    EXPECT_LE(marks.count(), 6) << "noise " << noise;
  }
}

TEST(MixedPixelFilter, ASharpEdgeMarksAtMostThreeReturnsOfARing) {
  RandomStream random(1, "range_steps.test");
  const ProfileScan seen = scan_of(wall_with_recess(0.3), 0.01, 16, random);
  const Marks marks(seen.scan);
  const double edge = std::atan2(kWall, 3.0);  // the wall ends 3 m ahead
  int elsewhere = 0;
  for (std::size_t i = 0; i < seen.azimuth.size(); ++i) {
    const double on_the_wall = (seen.azimuth[i] - edge) / kStep;
    if (marks.marked[i] && (on_the_wall < -1.01 || on_the_wall > 2.01)) ++elsewhere;
  }
  EXPECT_LE(elsewhere, 3) << "noise, of 14000 returns";
  EXPECT_LE(marks.count(), 3 * 16 + 3);
}

// The wall ends in front of the back of a recess. What is hidden behind its end is missing from the
// scan, so the end itself has to be; the back of the recess begins where the map may see it begin.
TEST(MixedPixelFilter, MarksTheEndOfTheNearerSurfaceOnEitherSideOfTheRobot) {
  RandomStream random(9, "range_steps.test");
  for (const bool behind : {false, true}) {
    const auto from_the_recess = [&](double azimuth) { return behind ? M_PI - azimuth : azimuth; };
    const Profile wall = wall_with_recess(0.3);
    const auto profile = [&](double azimuth) { return wall(from_the_recess(azimuth)); };
    const ProfileScan seen = scan_of(profile, 0.005, 16, random);
    const Marks marks(seen.scan);
    int ends = 0;
    for (std::size_t i = 0; i < seen.azimuth.size(); ++i) {
      const double edge = std::atan2(kWall, 3.0);
      const double on_the_wall = (from_the_recess(seen.azimuth[i]) - edge) / kStep;
      if (on_the_wall > 0.0 && on_the_wall < 1.0) {
        EXPECT_TRUE(marks.marked[i]) << on_the_wall;
        ++ends;
      }
      if (on_the_wall < -1.01 && on_the_wall > -10.0) {
        EXPECT_FALSE(marks.marked[i]) << on_the_wall;
      }
    }
    EXPECT_EQ(ends, 16) << "behind: " << behind;
  }
}

TEST(MixedPixelFilter, MarksTheReturnBetweenBothSurfaces) {
  RandomStream random(5, "range_steps.test");
  const double edge = std::atan2(kWall, 3.0);
  const Profile sharp = wall_with_recess(0.3);
  double wall = 0.0;                        // part of the footprint that is on the wall
  const auto mixed = [&](double azimuth) {  // the footprint is as wide as the step between firings
    if (std::abs(azimuth - edge) > 0.5 * kStep) return sharp(azimuth);
    return wall * sharp(azimuth + kStep) + (1.0 - wall) * sharp(azimuth - kStep);
  };
  // A tenth of 0.87 m is too little, with this noise, to take it for the end of a nearer surface.
  for (const auto& [part, noise] : {std::pair{0.5, 0.005}, {0.1, 0.02}}) {
    wall = part;
    const ProfileScan seen = scan_of(mixed, noise, 16, random);
    const Marks marks(seen.scan);
    int between = 0;
    for (std::size_t i = 0; i < seen.azimuth.size(); ++i) {
      if (std::abs(seen.azimuth[i] - edge) > 0.5 * kStep) continue;
      EXPECT_TRUE(marks.marked[i]) << part;
      ++between;
    }
    EXPECT_EQ(between, 16);
  }
}

TEST(MixedPixelFilter, AGapIsNoStep) {
  RandomStream random(6, "range_steps.test");
  ProfileScan seen = scan_of(wall_with_recess(0.3), 0.01, 16, random);
  const double edge = std::atan2(kWall, 3.0);
  LidarScan without;
  for (std::size_t i = 0; i < seen.azimuth.size(); ++i) {
    if (std::abs(seen.azimuth[i] - edge) > 5.0 * kStep) {
      without.points.push_back(seen.scan.points[i]);
    }
  }
  const Marks marks(without);
  EXPECT_EQ(marks.count(), 0);
}

// A LiDAR whose returns carry no ring: neighbours in time look in different directions.
TEST(MixedPixelFilter, WithoutRingsHardlyAnythingIsMarked) {
  RandomStream random(7, "range_steps.test");
  LidarScan scan;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d direction = random.normal3().normalized();
    const double range = 1.1 / std::max(std::abs(direction.y()), 0.05);
    scan.points.push_back({(range * direction).cast<float>(), 0.5F, 5000 * i, 0});
  }
  const Marks marks(scan);
  EXPECT_LT(marks.count(), 200);
}

TEST(MixedPixelFilter, IgnoresReturnsThatAreNotFinite) {
  RandomStream random(8, "range_steps.test");
  ProfileScan seen = scan_of(wall_with_recess(0.3), 0.01, 4, random);
  seen.scan.points[100].position.setConstant(std::numeric_limits<float>::quiet_NaN());
  seen.scan.points[200].position.setZero();
  for (std::size_t i = 20; i < 60; ++i) {
    seen.scan.points[i].position.setConstant(std::numeric_limits<float>::infinity());
  }
  const Marks marks(seen.scan);
  EXPECT_FALSE(marks.marked[100]);
  EXPECT_FALSE(marks.marked[200]);
  EXPECT_FALSE(marks.marked[40]);
  EXPECT_NEAR(marks.range_noise, 0.01, 0.002);
  EXPECT_GT(marks.count(), 0);
}

}  // namespace
}  // namespace aims
