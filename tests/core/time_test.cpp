// SPDX-License-Identifier: BSD-3-Clause
#include "core/time.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

TEST(Time, SecondsRoundTripToTheNanosecond) {
  for (const Duration each :
       {Duration{0}, Duration{1}, Duration{-1}, 123'456'789 * Duration{1000}, 7 * kSecond + 1}) {
    EXPECT_EQ(from_seconds(to_seconds(each)), each);
  }
}

TEST(Time, SecondsAreRoundedNotCut) {
  EXPECT_EQ(from_seconds(0.1), 100 * kMillisecond);
  EXPECT_EQ(from_seconds(0.3), 300 * kMillisecond);
  EXPECT_EQ(from_seconds(1.6e-9), 2);
  EXPECT_EQ(from_seconds(-1.6e-9), -2);
}

}  // namespace
}  // namespace aims
