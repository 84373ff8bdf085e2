// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/relief.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/random.hpp"
#include "tests/independent/cells.hpp"

namespace aims::independent {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t kSeed = 17;
constexpr double kRelief = 0.0015;

/// A corridor of 1080 m, which has room for its longest waves many times.
World corridor(double relief, std::uint64_t seed = kSeed) {
  World world = make_cell("plain_open_30")->world;
  world.relief = std::make_shared<Relief>(world.room, relief, seed);
  return world;
}

/// How far behind its plane a ray at right angles meets the left or right wall at (x, z).
double depth(const World& world, double x, double z, double side) {
  return world.distance({x, 0.0, z}, side * Vector3d::UnitY()) - 1.1;
}

/// Root of the mean square of a function of 20,000 places (x, z) on a wall.
double rms(const std::function<double(double, double)>& function) {
  RandomStream random(kSeed, "places");
  constexpr int kPlaces = 20000;
  double squares = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    squares += std::pow(function(random.uniform(-400.0, 400.0), random.uniform(0.1, 2.5)), 2);
  }
  return std::sqrt(squares / kPlaces);
}

TEST(Relief, HeightsHaveTheirDeviation) {
  std::printf("seed %lu\n", static_cast<unsigned long>(kSeed));
  for (const double relief : {0.0015, 0.003}) {
    const World world = corridor(relief);
    for (const double side : {-1.0, 1.0}) {
      const double deviation = rms([&](double x, double z) { return depth(world, x, z, side); });
      EXPECT_NEAR(deviation, relief, 0.06 * relief) << side;
    }
  }
}

// By hand: a lattice with the spacing s and the deviation d has the slope d / s (20 / (7 k))^(1/2)
// with k = 181 / 231, what interpolation leaves along the other axis; d^2 is s / 3 m of the whole.
TEST(Relief, SlopesAreThoseOfTheSpectrum) {
  const double expected = kRelief * std::sqrt(20.0 / 7.0 * 231.0 / 181.0 * (9.375 / 3.0));
  EXPECT_NEAR(expected, 5.06e-3, 0.01e-3);
  const World world = corridor(kRelief);
  constexpr double kApart = 0.004;
  const auto along = [&](double x, double z) {
    return (depth(world, x + kApart, z, 1.0) - depth(world, x, z, 1.0)) / kApart;
  };
  const auto upwards = [&](double x, double z) {
    return (depth(world, x, z + kApart, 1.0) - depth(world, x, z, 1.0)) / kApart;
  };
  EXPECT_NEAR(rms(along), expected, 0.04 * expected);
  EXPECT_NEAR(rms(upwards), expected, 0.04 * expected);
}

TEST(Relief, EveryWallAndEverySeedHasItsOwn) {
  const World world = corridor(kRelief);
  const World other = corridor(kRelief, kSeed + 1);
  const double independent = std::sqrt(2.0) * kRelief;
  EXPECT_NEAR(
      rms([&](double x, double z) { return depth(world, x, z, 1.0) - depth(world, x, z, -1.0); }),
      independent, 0.06 * independent);
  EXPECT_NEAR(
      rms([&](double x, double z) { return depth(world, x, z, 1.0) - depth(other, x, z, 1.0); }),
      independent, 0.06 * independent);
}

// Where a ray at right angles meets the wall, so must a ray along it.
TEST(Relief, GrazingRaysMeetTheSurfaceWhereOthersDo) {
  const World world = corridor(0.003);
  RandomStream random(kSeed, "grazing");
  double farthest = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    const double incidence = random.uniform(0.03, 0.1);
    const Vector3d origin(random.uniform(-300.0, 300.0), random.uniform(-0.5, 0.5), 1.3);
    const Vector3d direction =
        Vector3d(random.chance(0.5) ? 1.0 : -1.0, side * incidence, 0.2 * incidence).normalized();
    const Vector3d hit = origin + world.distance(origin, direction) * direction;
    ASSERT_NEAR(std::abs(hit.y()) - 1.1, depth(world, hit.x(), hit.z(), side), 1e-6) << i;
    farthest = std::max(farthest, (hit - origin).norm());
  }
  EXPECT_GT(farthest, 40.0);
}

TEST(Relief, OfNoneIsAPlane) {
  World planes = make_cell("doors_30")->world;
  World world = planes;
  world.relief = std::make_shared<Relief>(world.room, 0.0, kSeed);
  RandomStream random(kSeed, "planes");
  for (int i = 0; i < 2000; ++i) {
    const Vector3d direction = random.normal3().normalized();
    const Vector3d origin(random.uniform(0.0, 70.0), random.uniform(-0.5, 0.5), 0.5);
    EXPECT_NEAR(world.distance(origin, direction), planes.distance(origin, direction), 1e-6);
  }
}

}  // namespace
}  // namespace aims::independent
