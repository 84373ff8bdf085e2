// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/nearest_points.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/random.hpp"

namespace aims {
namespace {

/// A point offered.
struct Offered {
  float squared = 0.0F;
  std::uint32_t group = 0;
  std::uint32_t lane = 0;
};

std::vector<Offered> offer_groups(std::uint32_t groups, float largest, RandomStream& random,
                                  NearestPoints& nearest) {
  std::vector<Offered> all;
  for (std::uint32_t group = 0; group < groups; ++group) {
    Float4 squared{};
    for (std::uint32_t lane = 0; lane < 4; ++lane) {
      squared[lane] = static_cast<float>(random.uniform(0.0, largest));
      all.push_back({squared[lane], group, lane});
    }
    nearest.offer(squared, group);
  }
  return all;
}

// The fifth nearest by sorting; with one part in 2^15 either of two may be taken.
TEST(NearestPoints, AreThoseOfSorting) {
  RandomStream random(1, "nearest_points_test");
  for (int repetition = 0; repetition < 500; ++repetition) {
    NearestPoints nearest(0.25F);
    auto all = offer_groups(1 + repetition % 40, 0.3F, random, nearest);
    std::erase_if(all, [](const Offered& each) { return each.squared > 0.25F; });
    std::sort(all.begin(), all.end(),
              [](const Offered& a, const Offered& b) { return a.squared < b.squared; });
    std::array<NearestPoints::Found, NearestPoints::kWanted> found;
    const std::size_t count = nearest.sorted(found);
    ASSERT_EQ(count, std::min(all.size(), NearestPoints::kWanted));
    for (std::size_t k = 0; k < count; ++k) {
      const auto same = [&](const Offered& each) {
        return each.group == found[k].group && each.lane == found[k].lane;
      };
      const auto at = std::find_if(all.begin(), all.end(), same);
      ASSERT_NE(at, all.end());
      EXPECT_NEAR(at->squared, all[k].squared, 4e-5F * all[k].squared);
    }
  }
}

// What lies beyond the reach changes nothing, and within it there are five.
TEST(NearestPoints, ReachIsNoNearerThanTheFifth) {
  RandomStream random(2, "nearest_points_test");
  for (int repetition = 0; repetition < 200; ++repetition) {
    NearestPoints nearest(0.25F);
    EXPECT_NEAR(nearest.reach(), 0.25F, 1e-5F);
    const auto all = offer_groups(10, 0.25F, random, nearest);
    const float reach = nearest.reach();
    const auto within = std::count_if(all.begin(), all.end(), [reach](const Offered& each) {
      return each.squared <= reach * (1.0F + 4e-5F);
    });
    EXPECT_GE(within, 5);
    EXPECT_LT(reach, 0.25F);
  }
}

}  // namespace
}  // namespace aims
