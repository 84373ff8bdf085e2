// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/scan_matcher.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"

namespace aims {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// Points of the floor from x = -2 to 2 m, at z = `left` where x < 0 and at 0 elsewhere.
Points floor_points(int count, float left, RandomStream& random) {
  Points points;
  for (int i = 0; i < count; ++i) {
    const auto x = static_cast<float>(random.uniform(-2.0, 2.0));
    const auto y = static_cast<float>(random.uniform(-1.0, 1.0));
    points.emplace_back(x, y, x < 0.0F ? left : 0.0F);
  }
  return points;
}

/// Returns of the floor that count when one half of the map has it `step` [m] higher where x < 0.
int used_with_step(float step) {
  RandomStream random(1, "scan_matcher_test");
  VoxelMap map(MapConfig{});
  // The first two scans are in different halves.
  map.insert(floor_points(400, step, random), Eigen::Vector3f::Zero());
  map.insert(floor_points(400, 0.0F, random), Eigen::Vector3f::Zero());
  ScanMatcher matcher(20.0, RobustKernelConfig{});
  matcher.reset({0.0, 0.0, 1.0});
  const Pose at;
  Points points = floor_points(400, 0.0F, random);
  std::erase_if(points, [](const Eigen::Vector3f& p) {
    return std::abs(p.x()) < 0.5F || std::abs(p.x()) > 1.7F || std::abs(p.y()) > 0.7F;
  });
  matcher.match(at, points, map);
  return matcher.linearize(at).used;
}

// Where the halves of the map differ by more than the noise of a residual, the surface is no plane,
// and the mean of the two is no measurement of it.
TEST(ScanMatcher, AReturnCountsOnlyWhereTheHalvesAgree) {
  const int all = used_with_step(0.0F);
  EXPECT_GT(all, 100);
  EXPECT_NEAR(used_with_step(0.01F), all, 0.1 * all) << "less than the noise at the start";
  EXPECT_NEAR(used_with_step(0.08F), 0.5 * all, 0.1 * all) << "only where x > 0";
}

}  // namespace
}  // namespace aims
