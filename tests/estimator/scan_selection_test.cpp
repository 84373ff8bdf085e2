// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/scan_selection.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "core/random.hpp"

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

TEST(ScanSelection, KeepsTheFirstReturnOfEachVoxel) {
  const LidarScan scan = random_scan(5000);
  ScanSelection selection{LidarUpdateConfig{}};
  std::vector<int> kept;
  selection.select(scan, 0.5, 100000, kept);
  std::set<std::uint64_t> voxels;
  std::vector<int> expected;
  for (int i = 0; i < 5000; ++i) {
    const LidarPoint& p = scan.points[static_cast<std::size_t>(i)];
    if (selection.usable(p) && voxels.insert(voxel_key(voxel_of(p.position, 2.0F))).second) {
      expected.push_back(i);
    }
  }
  EXPECT_EQ(kept, expected);
}

TEST(ScanSelection, ThinsEvenlyBeyondTheLimit) {
  ScanSelection selection{LidarUpdateConfig{}};
  std::vector<int> kept;
  selection.select(random_scan(5000), 0.1, 500, kept);
  ASSERT_EQ(kept.size(), 500U);
  EXPECT_LT(kept.front(), 50);
  EXPECT_GT(kept.back(), 4900);
}

TEST(ScanSelection, IgnoresWhatIsNoReturn) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  LidarScan scan;
  scan.points.push_back({{nan, 1.0F, 1.0F}, 0.0F, 0, 0});
  scan.points.push_back({{INFINITY, 1.0F, 1.0F}, 0.0F, 0, 0});
  scan.points.push_back({{0.01F, 0.0F, 0.0F}, 0.0F, 0, 0});
  scan.points.push_back({{1000.0F, 0.0F, 0.0F}, 0.0F, 0, 0});
  scan.points.push_back({{2.0F, 0.0F, 0.0F}, 0.0F, 0, 0});
  ScanSelection selection{LidarUpdateConfig{}};
  std::vector<int> kept;
  selection.select(scan, 0.25, 100, kept);
  EXPECT_EQ(kept, std::vector<int>{4});
}

}  // namespace
}  // namespace aims
