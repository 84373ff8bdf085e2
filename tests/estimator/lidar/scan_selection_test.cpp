// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/scan_selection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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
  std::vector<int> kept;
  selection.begin(scan);
  selection.select(0.5, 100000, kept);
  const std::array<double, 3>& shift = selection.grid_shift();
  const Eigen::Vector3f offset(static_cast<float>(shift[0]), static_cast<float>(shift[1]),
                               static_cast<float>(shift[2]));
  const auto voxel_at = [&](int i) {
    return voxel_key(
        voxel_of(2.0F * scan.points[static_cast<std::size_t>(i)].position + offset, 1.0F));
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

/// Mean of the range noise of the returns selected from `scans` scans of a wall beside the sensor,
/// `distance` [m] away, in the order of a LiDAR that spins one way or the other.
double selected_noise(double distance, double sigma, bool reversed, RandomStream& random,
                      int& count) {
  ScanSelection selection{LidarUpdateConfig{}};
  double sum = 0.0;
  count = 0;
  for (int repetition = 0; repetition < 400; ++repetition) {
    LidarScan scan;
    std::vector<double> noise;
    for (int i = 0; i < 400; ++i) {
      const double azimuth = 0.1 + 0.002 * (reversed ? 399 - i : i);
      noise.push_back(sigma * random.normal());
      const double range = distance / std::sin(azimuth) + noise.back();
      const Eigen::Vector3d p(range * std::cos(azimuth), range * std::sin(azimuth), 0.1);
      scan.points.push_back({p.cast<float>(), 0.5F, i, 0});
    }
    std::vector<int> kept;
    selection.begin(scan);
    selection.select(0.25, 100000, kept);
    for (int i : kept) sum += noise[static_cast<std::size_t>(i)];
    count += static_cast<int>(kept.size());
  }
  return sum / count;
}

// For either direction of rotation the selected returns have no bias.
TEST(ScanSelection, DoesNotBiasNoiseByTheFiringOrder) {
  RandomStream random(2, "scan_selection");
  for (const bool reversed : {false, true}) {
    int count = 0;
    const double mean = selected_noise(1.1, 0.02, reversed, random, count);
    EXPECT_LT(std::abs(mean), 4.0 * 0.02 / std::sqrt(count));
  }
}

// Voxels that stood still would select as many of the few returns that noise pushes across the
// border beside a wall as of all the others: 5 mm at 1 cm inside the border, the other way beyond.
TEST(ScanSelection, DoesNotBiasNoiseNearTheBorderOfAVoxel) {
  RandomStream random(3, "scan_selection");
  for (const double distance : {0.98, 0.99, 1.0, 1.01, 1.02}) {
    int count = 0;
    const double mean = selected_noise(distance, 0.02, false, random, count);
    EXPECT_LT(std::abs(mean), 4.0 * 0.02 / std::sqrt(count)) << distance << " m";
  }
}

TEST(ScanSelection, ThinsEvenlyBeyondTheLimit) {
  const std::vector<int> kept = selected(random_scan(5000), 0.1, 500);
  ASSERT_EQ(kept.size(), 500U);
  EXPECT_LT(kept.front(), 50);
  EXPECT_GT(kept.back(), 4900);
}

TEST(ScanSelection, ChoosesAmongTheReturnsOfTheSelectionBefore) {
  const LidarScan scan = random_scan(5000);
  ScanSelection selection{LidarUpdateConfig{}};
  std::vector<int> fine;
  std::vector<int> coarse;
  selection.begin(scan);
  selection.select(0.25, 100000, fine);
  selection.select(0.5, 100000, coarse);
  std::sort(fine.begin(), fine.end());
  std::sort(coarse.begin(), coarse.end());
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
