// SPDX-License-Identifier: BSD-3-Clause
// What a scan costs in operations: numbers that no other load on the machine changes.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "core/random.hpp"
#include "estimator/lidar/mixed_pixel_filter.hpp"
#include "estimator/lidar/scan_selection.hpp"
#include "estimator/lidar/voxel_map.hpp"
#include "estimator/registry.hpp"
#include "tests/support/kinematic_world.hpp"

namespace {
thread_local long allocation_count = 0;
thread_local std::size_t allocated_bytes = 0;
}  // namespace

void* operator new(std::size_t size) {
  ++allocation_count;
  allocated_bytes += size;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace aims {
namespace {

/// What the sensors deliver over 10 m of corridor, out and back.
const std::vector<Delivery>& walk(SensorRig& rig) {
  static test::KinematicWorld world({.walk = {.distance = 10.0}});
  static const std::vector<Delivery> deliveries = [] {
    std::vector<Delivery> all;
    world.advance(world.duration(), all);
    return all;
  }();
  rig = world.rig();
  return deliveries;
}

/// Allocations of `estimator` from each scan to the next, legs and IMU included, over the second
/// half of the walk: on the way back the map is known.
double allocations_per_scan(const char* name) {
  SensorRig rig;
  const std::vector<Delivery>& deliveries = walk(rig);
  auto estimator = make_estimator(name, rig);
  long total = 0;
  int scans = 0;
  for (std::size_t i = 0; i < deliveries.size(); ++i) {
    const long before = allocation_count;
    (*estimator)->consume(deliveries[i]);
    if (i < deliveries.size() / 2) continue;
    total += allocation_count - before;
    scans += static_cast<int>(std::holds_alternative<LidarScanPtr>(deliveries[i].measurement));
  }
  return static_cast<double>(total) / scans;
}

// The row of diagnostics is part of the result; the rest is the growth of lists of the results.
TEST(Operations, AScanAllocatesItsResultAlone) {
  for (const char* name : {"aims_d", "aims", "tfs_plus", "lio"}) {
    EXPECT_LT(allocations_per_scan(name), 1.2) << name;
  }
}

// Room for the returns of each ring, not for the densest ring in every one that a number can name.
TEST(Operations, AStrayRingTakesLittleMemory) {
  LidarScan scan;
  for (int i = 0; i < 28800; ++i) {
    scan.points.push_back({{5.0F, 1.0F, 0.0F}, 0.5F, 3000 * i, static_cast<std::uint16_t>(i % 4)});
  }
  scan.points[14400].ring = 65535;
  MixedPixelFilter steps;
  const std::size_t before = allocated_bytes;
  steps.mark(scan);
  EXPECT_LT(allocated_bytes - before, 20e6);
}

TEST(Operations, ASearchTakesFewOfThe27Voxels) {
  SensorRig rig;
  VoxelMap map{MapConfig{}};
  ScanSelection selection{LidarUpdateConfig{}};
  std::vector<int> kept;
  std::vector<Eigen::Vector3f> points;
  int scans = 0;
  for (const Delivery& delivery : walk(rig)) {
    const auto* scan = std::get_if<LidarScanPtr>(&delivery.measurement);
    if (scan == nullptr || scans >= 8) continue;
    ++scans;  // all while the robot stands, so from one pose
    selection.begin(**scan);
    selection.select(0.1, 12000, kept);
    points.clear();
    for (const int i : kept) {
      points.push_back((*scan)->points[static_cast<std::size_t>(i)].position);
    }
    map.insert(points, Eigen::Vector3f::Zero());
  }
  double voxels = 0.0;
  std::array<Neighbors, kHalves> found;
  for (const Eigen::Vector3f& point : points) voxels += map.nearest(point, found);
  EXPECT_LT(voxels / static_cast<double>(points.size()), 6.0);
}

}  // namespace
}  // namespace aims
