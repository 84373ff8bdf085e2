// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/contact_detector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace aims {
namespace {

/// Loads that are the same for each foot.
std::vector<FootLoads> same(const std::vector<double>& values) {
  std::vector<FootLoads> loads;
  for (const double value : values) loads.push_back({value, value, value, value});
  return loads;
}

TEST(ContactDetector, KeepsAContactUntilTheLowerThreshold) {
  ContactDetector detector({{{30.0, 10.0}, {30.0, 10.0}, {5.0, 5.0}, {5.0, 5.0}}});
  const auto seen = [&](double load) { return detector.detect({load, -load, load, 0.0}); };
  EXPECT_EQ(seen(29.0), (std::array<bool, 4>{false, false, true, false}));
  EXPECT_EQ(seen(30.0), (std::array<bool, 4>{true, true, true, false}));
  EXPECT_EQ(seen(10.0), (std::array<bool, 4>{true, true, true, false}));
  EXPECT_EQ(seen(9.9), (std::array<bool, 4>{false, false, true, false}));
  EXPECT_EQ(seen(20.0), (std::array<bool, 4>{false, false, true, false}));
}

/// Of two values the split is exact: the middle of their logarithms, a tenth of the distance apart.
TEST(ContactThresholds, LieAroundTheMiddleOfTheLogarithms) {
  std::vector<double> values(70, 0.0);
  values.resize(200, 99.0);
  const auto learned = learn_contact_thresholds(same(values));
  ASSERT_TRUE(learned) << learned.error().message;
  for (const ContactThreshold& each : *learned) {
    EXPECT_NEAR(each.begin, std::pow(100.0, 0.6) - 1.0, 1e-9);
    EXPECT_NEAR(each.end, std::pow(100.0, 0.4) - 1.0, 1e-9);
  }
}

TEST(ContactThresholds, SeparateSwingFromStanceOfEachFoot) {
  std::mt19937 random(5);
  SCOPED_TRACE("seed 5");
  std::normal_distribution<double> noise(0.0, 3.0);
  std::uniform_real_distribution<double> relative(0.6, 1.4);
  const FootLoads swing = {15.0, 0.0, 40.0, 8.0}, stance = {90.0, 60.0, 300.0, 200.0};
  std::vector<FootLoads> loads;
  for (int i = 0; i < 5000; ++i) {
    FootLoads each;
    for (std::size_t leg = 0; leg < each.size(); ++leg) {
      const bool standing = (i / 40 + static_cast<int>(leg)) % 2 == 0;
      each[leg] =
          std::max(0.0, standing ? stance[leg] * relative(random) : swing[leg] + noise(random));
    }
    loads.push_back(each);
  }
  const auto learned = learn_contact_thresholds(loads);
  ASSERT_TRUE(learned) << learned.error().message;
  for (std::size_t leg = 0; leg < swing.size(); ++leg) {
    EXPECT_GT((*learned)[leg].end, swing[leg]);
    EXPECT_LT((*learned)[leg].begin, 0.7 * stance[leg]);
    EXPECT_GT((*learned)[leg].begin, (*learned)[leg].end);
  }
}

TEST(ContactThresholds, AreNotLearnedFromOneClass) {
  std::mt19937 random(6);
  SCOPED_TRACE("seed 6");
  std::normal_distribution<double> bell(5.0, 0.3);
  std::uniform_real_distribution<double> flat(1.0, 6.0);
  std::vector<double> bells, flats, rare(1000, 3.0);
  for (int i = 0; i < 20'000; ++i) {
    bells.push_back(std::expm1(bell(random)));
    flats.push_back(std::expm1(flat(random)));
  }
  rare.resize(1030, 100.0);
  for (const std::vector<double>& values : {bells, flats, rare}) {
    const auto learned = learn_contact_thresholds(same(values));
    ASSERT_FALSE(learned);
    EXPECT_NE(learned.error().message.find("FL: loads near "), std::string::npos);
    EXPECT_NE(learned.error().message.find("are not two classes"), std::string::npos);
  }
  // A robot that stands: counts that flicker by one, and weight that shifts.
  std::vector<double> flickering, shifting;
  for (int i = 0; i < 600; ++i) {
    flickering.push_back(100 + i % 2);
    shifting.push_back(i < 300 ? 40.0 : 55.0);
  }
  for (const std::vector<double>& values : {flickering, shifting}) {
    const auto learned = learn_contact_thresholds(same(values));
    ASSERT_FALSE(learned);
    EXPECT_NE(learned.error().message.find("are those of a standing foot"), std::string::npos);
  }
  EXPECT_EQ(learn_contact_thresholds(same(std::vector<double>(500, 7.0))).error().message,
            "FL: all loads are equal");
  EXPECT_EQ(learn_contact_thresholds(same({1.0, NAN})).error().message,
            "FL: expected at least 100 loads, found 1");
}

}  // namespace
}  // namespace aims
