// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/range_steps.hpp"

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
  explicit Marks(const LidarScan& scan) : mixed(scan.points.size(), false) {
    RangeSteps steps;
    steps.mark(scan);
    for (std::size_t i = 0; i < scan.points.size(); ++i) mixed[i] = steps.mixed(i);
    range_noise = steps.range_noise();
  }
  auto count() const { return std::ranges::count(mixed, true); }

  std::vector<bool> mixed;  ///< by the index of the return
  double range_noise = 0.0;
};

// The far side of a recess meets its back and the wall at corners. It constrains the direction of
// the corridor and has to stay.
TEST(RangeSteps, LeavesCornersAlone) {
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

TEST(RangeSteps, MeasuresTheRangeNoiseOfTheScan) {
  RandomStream random(3, "range_steps.test");
  for (const double noise : {0.005, 0.02, 0.1}) {
    const ProfileScan seen = scan_of(wall_with_recess(0.3), noise, 16, random);
    const Marks marks(seen.scan);
    EXPECT_NEAR(marks.range_noise, noise, 0.1 * noise);
  }
}

TEST(RangeSteps, TakesNoiseForNoStep) {
  RandomStream random(4, "range_steps.test");
  for (const double noise : {0.005, 0.02, 0.1}) {
    const ProfileScan seen = scan_of(wall_with_recess(0.0), noise, 16, random);
    const Marks marks(seen.scan);
    EXPECT_LE(marks.count(), 6) << "noise " << noise;
  }
}

TEST(RangeSteps, ASharpEdgeMixesAtMostOneReturnOfARing) {
  RandomStream random(1, "range_steps.test");
  const ProfileScan seen = scan_of(wall_with_recess(0.3), 0.01, 16, random);
  const Marks marks(seen.scan);
  const double edge = std::atan2(kWall, 3.0);  // the wall ends 3 m ahead
  int elsewhere = 0;
  for (std::size_t i = 0; i < seen.azimuth.size(); ++i) {
    if (marks.mixed[i] && std::abs(seen.azimuth[i] - edge) > 1.01 * kStep) ++elsewhere;
  }
  EXPECT_LE(elsewhere, 2) << "noise, of 14000 returns";
  EXPECT_LE(marks.count(), 2 * 16 + 2);
}

TEST(RangeSteps, MarksTheReturnBetweenBothSurfaces) {
  RandomStream random(5, "range_steps.test");
  const double edge = std::atan2(kWall, 3.0);
  const Profile sharp = wall_with_recess(0.3);
  const auto mixed = [&](double azimuth) {  // the footprint is as wide as the step between firings
    if (std::abs(azimuth - edge) > 0.5 * kStep) return sharp(azimuth);
    return 0.5 * (sharp(azimuth - kStep) + sharp(azimuth + kStep));
  };
  const ProfileScan seen = scan_of(mixed, 0.005, 16, random);
  const Marks marks(seen.scan);
  int between = 0;
  for (std::size_t i = 0; i < seen.azimuth.size(); ++i) {
    if (std::abs(seen.azimuth[i] - edge) > 0.5 * kStep) continue;
    EXPECT_TRUE(marks.mixed[i]);
    ++between;
  }
  EXPECT_EQ(between, 16);
}

TEST(RangeSteps, AGapIsNoStep) {
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
TEST(RangeSteps, WithoutRingsHardlyAnythingIsMarked) {
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

TEST(RangeSteps, IgnoresReturnsThatAreNotFinite) {
  RandomStream random(8, "range_steps.test");
  ProfileScan seen = scan_of(wall_with_recess(0.3), 0.01, 4, random);
  seen.scan.points[100].position.setConstant(std::numeric_limits<float>::quiet_NaN());
  seen.scan.points[200].position.setZero();
  for (std::size_t i = 20; i < 60; ++i) {
    seen.scan.points[i].position.setConstant(std::numeric_limits<float>::infinity());
  }
  const Marks marks(seen.scan);
  EXPECT_FALSE(marks.mixed[100]);
  EXPECT_FALSE(marks.mixed[200]);
  EXPECT_FALSE(marks.mixed[40]);
  EXPECT_NEAR(marks.range_noise, 0.01, 0.002);
  EXPECT_GT(marks.count(), 0);
}

}  // namespace
}  // namespace aims
