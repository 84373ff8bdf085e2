// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/nearest_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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

/// Two searches, of few and of many groups.
struct Searches {
  std::array<NearestPoints, 2> nearest{NearestPoints(0.25F), NearestPoints(0.25F)};
  std::array<std::vector<Offered>, 2> offered;

  void offer(std::array<std::uint32_t, 2> groups, float largest, RandomStream& random) {
    for (std::size_t i = 0; i < 2; ++i) {
      offered[i] = offer_groups(groups[i], largest, random, nearest[i]);
    }
  }
};

/// Expects `sorted` to be the nearest of `all`; with one part in 2^15 either of two may be taken.
void expect_nearest(const NearestPoints::Sorted& sorted, std::vector<Offered> all) {
  std::erase_if(all, [](const Offered& each) { return each.squared > 0.25F; });
  std::ranges::sort(all, {}, &Offered::squared);
  ASSERT_EQ(sorted.count, std::min(all.size(), NearestPoints::kWanted));
  for (std::size_t k = 0; k < sorted.count; ++k) {
    const NearestPoints::Found found = sorted.points[k];
    const auto same = [&](const Offered& each) {
      return each.group == found.group && each.lane == found.lane;
    };
    const auto at = std::ranges::find_if(all, same);
    ASSERT_NE(at, all.end());
    EXPECT_NEAR(at->squared, all[k].squared, 4e-5F * all[k].squared);
  }
}

TEST(NearestPoints, AreThoseOfSorting) {
  RandomStream random(1, "nearest_points_test");
  for (std::uint32_t repetition = 0; repetition < 500; ++repetition) {
    Searches searches;
    searches.offer({1 + repetition % 40, 1 + repetition % 7}, 0.3F, random);
    const auto sorted = NearestPoints::sorted(searches.nearest[0], searches.nearest[1]);
    for (std::size_t i = 0; i < 2; ++i) expect_nearest(sorted[i], searches.offered[i]);
  }
}

// All lanes of a group may be as near as each other: each of them is found once.
TEST(NearestPoints, AsNearAsEachOtherAreDifferentPoints) {
  std::array<NearestPoints, 2> nearest{NearestPoints(0.25F), NearestPoints(0.25F)};
  nearest[0].offer(Float4{0.01F, 0.01F, 0.01F, 0.01F}, 0);
  nearest[0].offer(Float4{0.2F, 0.02F, 0.2F, 0.2F}, 1);
  const auto sorted = NearestPoints::sorted(nearest[0], nearest[1]);
  ASSERT_EQ(sorted[0].count, 5U);
  EXPECT_EQ(sorted[1].count, 0U);
  for (std::uint32_t k = 0; k < 4; ++k) {
    EXPECT_EQ(sorted[0].points[k].group, 0U);
    EXPECT_EQ(sorted[0].points[k].lane, k);
  }
  EXPECT_EQ(sorted[0].points[4].group, 1U);
  EXPECT_EQ(sorted[0].points[4].lane, 1U);
}

// What lies beyond the reach changes nothing, and within it there are five of each.
TEST(NearestPoints, ReachIsNoNearerThanTheFifth) {
  RandomStream random(2, "nearest_points_test");
  for (int repetition = 0; repetition < 200; ++repetition) {
    Searches searches;
    const auto reach = [&] {
      return NearestPoints::reach(searches.nearest[0], searches.nearest[1]);
    };
    EXPECT_NEAR(reach(), 0.25F, 1e-5F);
    searches.offer({10, 4}, 0.25F, random);
    EXPECT_LT(reach(), 0.25F);
    for (const std::vector<Offered>& all : searches.offered) {
      const auto within = std::ranges::count_if(
          all, [&](const Offered& each) { return each.squared <= reach() * (1.0F + 4e-5F); });
      EXPECT_GE(within, 5);
    }
  }
}

}  // namespace
}  // namespace aims
