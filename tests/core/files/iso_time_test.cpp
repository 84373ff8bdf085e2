// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/iso_time.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

constexpr Time kNoon = 1'682'942'400 * kSecond;  // 2023-05-01T12:00:00Z

Time time_of(const char* text) { return parse_iso_time(text).value_or(IsoTime{-1, false}).time; }

TEST(IsoTime, IsReadToTheNanosecondInAnyZone) {
  EXPECT_EQ(time_of("2023-05-01T12:00:00Z"), kNoon);
  EXPECT_EQ(time_of("2023-05-01 12:00:00.123"), kNoon + 123 * kMillisecond);
  EXPECT_EQ(time_of("2023-05-01T12:00:00,123456789Z"), kNoon + 123'456'789);
  EXPECT_EQ(time_of("2023-05-01T12:00:00.1234567899Z"), kNoon + 123'456'789);
  EXPECT_EQ(time_of("2023-05-01T14:00:00+02:00"), kNoon);
  EXPECT_EQ(time_of("2023-05-01T06:30:00-0530"), kNoon);
  EXPECT_EQ(time_of("2024-02-29T00:00:00Z"), 1'709'164'800 * kSecond);
  EXPECT_EQ(time_of("1970-01-01T00:00:00Z"), 0);
}

TEST(IsoTime, SaysWhetherAZoneIsStated) {
  EXPECT_TRUE(parse_iso_time("2023-05-01T12:00:00Z")->has_zone);
  EXPECT_FALSE(parse_iso_time("2023-05-01T12:00:00")->has_zone);
}

TEST(IsoTime, OtherTextsAreNone) {
  for (const char* text :
       {"", "1682942400.5", "2023-05-01", "2023-13-01T12:00:00Z", "2023-02-29T12:00:00Z",
        "2023-05-01T25:00:00Z", "2023-05-01T12:00:00.Z", "2023-05-01T12:00:00ZZ",
        "9999-05-01T12:00:00Z", "2023-05-01T12:00", "12:00:00", "2023-05-01T12:00:00+2"}) {
    EXPECT_FALSE(parse_iso_time(text)) << text;
  }
}

}  // namespace
}  // namespace aims
