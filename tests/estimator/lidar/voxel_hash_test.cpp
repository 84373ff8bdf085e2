// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/voxel_hash.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace aims {
namespace {

std::vector<std::uint64_t> keys_of_a_box(int nx, int ny, int nz) {
  std::vector<std::uint64_t> keys;
  for (int x = 0; x < nx; ++x) {
    for (int y = 0; y < ny; ++y) {
      for (int z = 0; z < nz; ++z) keys.push_back(voxel_key({x - nx / 2, y - ny / 2, z - nz / 2}));
    }
  }
  return keys;
}

TEST(VoxelHash, FindsInsertedKeys) {
  VoxelHash hash(4);
  const auto keys = keys_of_a_box(20, 20, 20);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    ASSERT_EQ(hash.find_or_insert(keys[i], static_cast<int>(i)), static_cast<int>(i));
  }
  for (std::size_t i = 0; i < keys.size(); ++i) ASSERT_EQ(hash.find(keys[i]), static_cast<int>(i));
  EXPECT_EQ(hash.find(voxel_key({100, 0, 0})), VoxelHash::kNone);
  hash.clear();
  EXPECT_EQ(hash.find(keys[0]), VoxelHash::kNone);
}

// Lines and walls of voxels, whose keys differ in one or two coordinates only, need about as many
// probes as random keys: at half load, linear probing takes 1.5 on average.
TEST(VoxelHash, VoxelsOfWallsDoNotCluster) {
  for (const auto& [nx, ny, nz] : {std::array{8000, 1, 1},
                                   {1, 8000, 1},
                                   {1, 1, 8000},
                                   {1000, 1, 8},
                                   {200, 40, 1},
                                   {20, 20, 20}}) {
    VoxelHash hash(16);
    const auto keys = keys_of_a_box(nx, ny, nz);
    for (std::uint64_t key : keys) hash.find_or_insert(key, 0);
    double probes = 0.0;
    for (std::uint64_t key : keys) probes += hash.probes(key);
    EXPECT_LT(probes / static_cast<double>(keys.size()), 1.6) << nx << " x " << ny << " x " << nz;
  }
}

}  // namespace
}  // namespace aims
