// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/scan_selection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/random.hpp"
#include "estimator/lidar/voxel_hash.hpp"

namespace aims {
namespace {

LidarScan random_scan(int count) {
  RandomStream random(1, "scan_selection");
  LidarScan scan;
  for (int i = 0; i < count; ++i) {
    scan.points.push_back({(3.0 * random.normal3()).cast<float>(), 0.5F, i, 0});
  }
  return scan;
}

std::vector<int> selected(const LidarScan& scan, double voxel, int limit) {
  ScanSelection selection{LidarUpdateConfig{}};
  std::vector<int> kept;
  selection.begin(scan);
  selection.select(voxel, limit, kept);
  return kept;
}

TEST(ScanSelection, KeepsOneReturnOfEachVoxel) {
  const LidarScan scan = random_scan(5000);
  ScanSelection selection{LidarUpdateConfig{}};
  const std::vector<int> kept = selected(scan, 0.5, 100000);
  const auto voxel_at = [&scan](int i) {
    return voxel_key(voxel_of(scan.points[static_cast<std::size_t>(i)].position, 2.0F));
  };
  std::set<std::uint64_t> occupied;
  for (int i = 0; i < 5000; ++i) {
    if (selection.usable(scan.points[static_cast<std::size_t>(i)])) occupied.insert(voxel_at(i));
  }
  std::set<std::uint64_t> represented;
  for (int i : kept) represented.insert(voxel_at(i));
  EXPECT_EQ(kept.size(), represented.size());
  EXPECT_EQ(represented, occupied);
}

// Returns of a straight wall at a grazing angle, in the order of a spinning LiDAR, with noise along
// the beams: for either direction of rotation the selected ones have no bias.
TEST(ScanSelection, DoesNotBiasNoiseByTheFiringOrder) {
  RandomStream random(2, "scan_selection");
  for (const bool reversed : {false, true}) {
    double sum = 0.0;
    int count = 0;
    for (int repetition = 0; repetition < 200; ++repetition) {
      LidarScan scan;
      std::vector<double> noise;
      for (int i = 0; i < 400; ++i) {
        const double azimuth = 0.1 + 0.002 * (reversed ? 399 - i : i);
        noise.push_back(0.02 * random.normal());
        const double range = 1.1 / std::sin(azimuth) + noise.back();
        const Eigen::Vector3d p(range * std::cos(azimuth), range * std::sin(azimuth), 0.1);
        scan.points.push_back({p.cast<float>(), 0.5F, i, 0});
      }
      const std::vector<int> kept = selected(scan, 0.25, 100000);
      for (int i : kept) sum += noise[static_cast<std::size_t>(i)];
      count += static_cast<int>(kept.size());
    }
    EXPECT_LT(std::abs(sum / count), 4.0 * 0.02 / std::sqrt(count));
  }
}

TEST(ScanSelection, ThinsEvenlyBeyondTheLimit) {
  const std::vector<int> kept = selected(random_scan(5000), 0.1, 500);
  ASSERT_EQ(kept.size(), 500U);
  EXPECT_LT(kept.front(), 50);
  EXPECT_GT(kept.back(), 4900);
}

// Where the voxels of the second selection are unions of those of the first, it chooses as it would
// among all returns.
TEST(ScanSelection, ChoosesAmongTheReturnsOfTheSelectionBefore) {
  const LidarScan scan = random_scan(5000);
  ScanSelection selection{LidarUpdateConfig{}};
  std::vector<int> fine;
  std::vector<int> coarse;
  selection.begin(scan);
  selection.select(0.25, 100000, fine);
  selection.select(0.5, 100000, coarse);
  std::vector<int> of_all = selected(scan, 0.5, 100000);
  std::sort(fine.begin(), fine.end());
  std::sort(coarse.begin(), coarse.end());
  std::sort(of_all.begin(), of_all.end());
  EXPECT_EQ(coarse, of_all);
  EXPECT_TRUE(std::includes(fine.begin(), fine.end(), coarse.begin(), coarse.end()));
  EXPECT_LT(coarse.size(), fine.size());
}

TEST(ScanSelection, IgnoresInvalidReturns) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  LidarScan scan;
  scan.points.push_back({{nan, 1.0F, 1.0F}, 0.0F, 0, 0});
  scan.points.push_back({{INFINITY, 1.0F, 1.0F}, 0.0F, 0, 0});
  scan.points.push_back({{0.01F, 0.0F, 0.0F}, 0.0F, 0, 0});
  scan.points.push_back({{1000.0F, 0.0F, 0.0F}, 0.0F, 0, 0});
  scan.points.push_back({{2.0F, 0.0F, 0.0F}, 0.0F, 0, 0});
  EXPECT_EQ(selected(scan, 0.25, 100), std::vector<int>{4});
}

}  // namespace
}  // namespace aims
