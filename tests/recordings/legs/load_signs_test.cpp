// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/load_signs.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace aims {
namespace {

/// A trot whose sensors say `scale` times the load plus `offset`: none or 90 N, 40 N while
/// standing.
LoadSign sign_with(double scale, double offset) {
  std::vector<FootLoads> loads;
  for (int i = 0; i < 400; ++i) {
    const double noise = 0.5 * (i % 5);
    const double load = i < 100 ? 40.0 : i / 10 % 2 == 0 ? 90.0 : 0.0;
    FootLoads each;
    each.fill(scale * load + offset + noise);
    loads.push_back(each);
  }
  return load_ranges(loads, 20.0)[2].sign;
}

TEST(LoadSigns, AreToldFromTheLoadsOfAWalk) {
  EXPECT_EQ(sign_with(1.0, 0.0), LoadSign::kPositive);
  EXPECT_EQ(sign_with(1.0, -5.0), LoadSign::kPositive) << "drift";
  EXPECT_EQ(sign_with(1.0, 60.0), LoadSign::kPositive);
  EXPECT_EQ(sign_with(-1.0, 0.0), LoadSign::kNegative);
  EXPECT_EQ(sign_with(-1.0, -10.0), LoadSign::kNegative);
  EXPECT_EQ(sign_with(1.0, -50.0), LoadSign::kUnclear) << "of both signs";
  EXPECT_EQ(sign_with(1.0, -200.0), LoadSign::kUnclear) << "a lifted foot has the larger one";
  EXPECT_EQ(sign_with(-1.0, 50.0), LoadSign::kUnclear);
  EXPECT_EQ(sign_with(0.0, -5.0), LoadSign::kPositive) << "negligible";
}

TEST(LoadSigns, LoadsThatLieTogetherAreThoseOfALiftedFoot) {
  const auto sign_of = [](double scale, double offset) {
    std::vector<FootLoads> loads(400);
    for (int i = 0; i < 400; ++i) {
      const double load = i / 10 % 2 == 0 ? 80.0 + 10.0 * (i % 10) : 0.2 * (i % 10);
      loads[static_cast<std::size_t>(i)].fill(scale * load + offset);
    }
    return load_ranges(loads, 20.0)[0].sign;
  };
  EXPECT_EQ(sign_of(-1.0, 0.0), LoadSign::kNegative);
  EXPECT_EQ(sign_of(1.0, -180.0), LoadSign::kUnclear);
}

TEST(LoadSigns, TextNamesTheFeetWithThatSign) {
  std::array<LoadRange, kLegCount> ranges{};
  EXPECT_EQ(feet_text(ranges, LoadSign::kNegative), "");
  ranges[0] = {-80.0, -2.0, LoadSign::kNegative};
  ranges[3] = {-75.0, 0.0, LoadSign::kNegative};
  EXPECT_EQ(feet_text(ranges, LoadSign::kNegative), "FL (-80 to -2), RR (-75 to 0)");
}

}  // namespace
}  // namespace aims
