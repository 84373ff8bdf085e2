// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support/walking.hpp"

namespace aims {
namespace {

/// 78.6 m and back; friction 0.4 to 1.0 and bumps of 0 to 2 cm vary with the seed.
class LongWalk : public ::testing::TestWithParam<int> {};

TEST_P(LongWalk, NeitherFallsNorTouchesAWall) {
  const int seed = GetParam();
  const double friction = 0.4 + 0.2 * (seed % 4);
  const double bump_height = 0.01 * (seed % 3);
  RecordProperty("seed", seed);
  Walker walker = Walker::create(testing::corridor_world(78.6, friction, bump_height, seed), {},
                                 testing::there_and_back(78.6))
                      .value();
  double widest = 0.0;
  bool touched = false;
  while (!walker.route().done() && !walker.fallen()) {
    walker.step();
    const RobotState& state = walker.world().state();
    ASSERT_LT(state.stamp, 400 * kSecond) << "seed " << seed;
    widest = std::max(widest, std::abs(state.T_world_base.translation.y()));
    touched = touched || state.touches_wall;
  }
  EXPECT_FALSE(walker.fallen()) << "seed " << seed;
  EXPECT_FALSE(touched) << "seed " << seed;
  EXPECT_LT(widest, 0.15) << "seed " << seed;
  EXPECT_EQ(walker.world().warning_count(), 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, LongWalk, ::testing::Range(1, 21));

}  // namespace
}  // namespace aims
