// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/part_joiner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/random.hpp"

namespace aims {
namespace {

constexpr std::size_t kParts = 4;
constexpr Duration kPeriod = 10 * kMillisecond;

/// A set without the samples, which hold their part and number.
struct Set {
  Time time = 0;
  std::vector<double> numbers;
  std::vector<bool> silent;
};

class Joiner : public testing::Test {
 protected:
  void add(std::size_t part, int number, Time time) {
    LegPartSample sample;
    sample.time = time;
    sample.angles = {static_cast<double>(number)};
    joiner_.add(part, std::move(sample));
    while (const auto set = joiner_.next()) {
      Set& added = sets_.emplace_back();
      added.time = set->time;
      added.silent = set->silent;
      for (const LegPartSample* each : set->samples) added.numbers.push_back(each->angles[0]);
    }
  }

  PartJoiner joiner_{kParts};
  std::vector<Set> sets_;
};

Time at(int number) { return kSecond + number * kPeriod; }

TEST_F(Joiner, SamplesOfOneInstantAreOneSet) {
  for (int k = 0; k < 50; ++k) {
    for (std::size_t part = 0; part < kParts; ++part) add((part + 1) % kParts, k, at(k));
    ASSERT_EQ(sets_.size(), static_cast<std::size_t>(k + 1)) << "given at once";
    EXPECT_EQ(sets_.back().time, at(k));
    EXPECT_EQ(sets_.back().numbers, std::vector<double>(kParts, k));
  }
}

TEST_F(Joiner, ALostSampleIsBridgedByTheOneBefore) {
  for (int k = 0; k < 50; ++k) {
    for (std::size_t part = 0; part < kParts; ++part) {
      if (part != 2 || k % 10 != 5) add(part, k, at(k));
    }
  }
  ASSERT_EQ(sets_.size(), 50U);
  for (int k = 0; k < 50; ++k) {
    const Set& set = sets_[static_cast<std::size_t>(k)];
    EXPECT_EQ(set.time, at(k));
    EXPECT_EQ(set.numbers[2], k % 10 == 5 ? k - 1 : k);
    EXPECT_EQ(std::ranges::count(set.silent, true), 0);
  }
}

TEST_F(Joiner, APauseOfAllPartsMakesNoSetOfSome) {
  for (int k = 0; k < 100; ++k) {
    if (k >= 40 && k < 60) continue;
    for (std::size_t part = 0; part < kParts; ++part) add(part, k, at(k));
  }
  ASSERT_EQ(sets_.size(), 80U);
  for (const Set& each : sets_) EXPECT_EQ(std::ranges::count(each.numbers, each.numbers[0]), 4);
}

TEST_F(Joiner, ASilentPartIsSaidToBeAndHoldsNothingUp) {
  for (int k = 0; k < 200; ++k) {
    for (std::size_t part = 0; part < kParts; ++part) {
      if (part != 3 || k < 50 || k >= 150) add(part, k, at(k));
    }
  }
  ASSERT_GE(sets_.size(), 199U);
  for (const Set& each : sets_) {
    const auto k = static_cast<int>((each.time - at(0)) / kPeriod);
    if (k > 55 && k < 148) {
      EXPECT_TRUE(each.silent[3]) << k;
    } else if (k < 50 || k > 155) {
      EXPECT_FALSE(each.silent[3]) << k;
    }
  }
}

TEST_F(Joiner, TheSlowestPartGivesTheRate) {
  for (int k = 0; k < 200; ++k) {
    for (std::size_t part = 0; part < kParts; ++part) {
      if (part == 0 || k % 4 == 0) add(part, k, at(k));
    }
  }
  EXPECT_NEAR(static_cast<double>(sets_.size()), 50.0, 1.0);
  for (const Set& each : sets_) {
    EXPECT_EQ(each.numbers[1], each.numbers[2]);
    EXPECT_LE(each.numbers[0] - each.numbers[1], 3.0);
  }
}

TEST_F(Joiner, PartsInBurstsOfTheirOwnAreAligned) {
  for (int burst = 0; burst < 20; ++burst) {
    for (std::size_t part = 0; part < kParts; ++part) {
      for (int k = 10 * burst; k < 10 * (burst + 1); ++k) add(part, k, at(k));
    }
  }
  ASSERT_GE(sets_.size(), 190U);
  for (const Set& each : sets_) EXPECT_EQ(std::ranges::count(each.numbers, each.numbers[0]), 4);
}

TEST_F(Joiner, JitterAndOtherOrdersLoseNoSamples) {
  RandomStream random(61, "jitter");
  for (int k = 0; k < 300; ++k) {
    std::vector<std::size_t> order = {0, 1, 2, 3};
    std::ranges::rotate(order, order.begin() + k % 4);
    for (const std::size_t part : order) {
      add(part, k, at(k) + from_seconds(0.002 * random.uniform(-1.0, 1.0)));
    }
  }
  EXPECT_GE(sets_.size(), 298U);
  for (std::size_t i = 1; i < sets_.size(); ++i) {
    EXPECT_GT(sets_[i].time, sets_[i - 1].time);
    const auto [least, most] = std::ranges::minmax(sets_[i].numbers);
    EXPECT_LE(most - least, 1.0);
  }
}

TEST_F(Joiner, APartOnAnotherClockMovesNoTime) {
  for (int k = 0; k < 200; ++k) {
    for (std::size_t part = 0; part < kParts; ++part) {
      add(part, k, at(part == 1 ? k : k + 500));
    }
  }
  ASSERT_GT(sets_.size(), 150U);
  for (std::size_t i = 100; i < sets_.size(); ++i) {
    EXPECT_TRUE(sets_[i].silent[1]);
    EXPECT_EQ(sets_[i].time, at(500 + static_cast<int>(sets_[i].numbers[0])));
  }
}

TEST_F(Joiner, AClockThatIsSetBackBeginsAnew) {
  for (int k = 0; k < 100; ++k) {
    for (std::size_t part = 0; part < kParts; ++part) add(part, k, at(k < 50 ? 1000 + k : k));
  }
  EXPECT_GE(sets_.size(), 96U);
}

}  // namespace
}  // namespace aims
