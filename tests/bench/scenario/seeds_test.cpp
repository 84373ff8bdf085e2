// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenario/seeds.hpp"

#include <gtest/gtest.h>

#include <string>

namespace aims {
namespace {

using Seeds = std::vector<std::uint64_t>;

TEST(Seeds, OneSeedARangeAndAListAreUnderstood) {
  EXPECT_EQ(parse_seeds("3").value(), Seeds({3}));
  EXPECT_EQ(parse_seeds("1-4").value(), Seeds({1, 2, 3, 4}));
  EXPECT_EQ(parse_seeds("7,1-3,2").value(), Seeds({7, 1, 2, 3}));
}

TEST(Seeds, AnythingElseIsRefusedWithTheTextGiven) {
  for (const char* bad : {"", "a", "-1", "3-1", "1,", "1-", "1 2", "0-99999999"}) {
    const auto parsed = parse_seeds(bad);
    ASSERT_FALSE(parsed) << bad;
    EXPECT_NE(parsed.error().message.find(std::string("'") + bad + "'"), std::string::npos);
  }
}

TEST(Seeds, LimitsAreNamed) {
  const std::string limits = "; allowed are up to 10000 seeds, each at most 2147483647";
  EXPECT_EQ(parse_seeds("1-99999999999").error().message,
            "--seeds: '1-99999999999': 99999999999 is too large" + limits);
  EXPECT_EQ(parse_seeds("0-10000").error().message, "--seeds: '0-10000': too many seeds" + limits);
  EXPECT_EQ(parse_seeds("0-9999,10000-10000").error().message,
            "--seeds: '0-9999,10000-10000': too many seeds" + limits);
  EXPECT_EQ(parse_seeds("1-10000").value().size(), 10000U);
  EXPECT_EQ(parse_seeds("2147483647").value(), Seeds({2147483647}));
  EXPECT_FALSE(parse_seeds("2147483648"));
}

}  // namespace
}  // namespace aims
