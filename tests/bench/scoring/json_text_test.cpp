// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/json_text.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

TEST(JsonText, WritesAnyBytesSoThatTheyAreReadBackAsText) {
  const Json json = {{"caf\xE9", {1, "a\xFF", {{"\x1b\n", nullptr}}}}, {"plain", "\xC3\xA9"}};
  const auto read = parse_json(json_text(json, 2), "a.json");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read,
            Json({{"caf\\xe9", {1, "a\\xff", {{"\x1b\n", nullptr}}}}, {"plain", "\xC3\xA9"}}));
  const Json valid = {{"plain", "\xC3\xA9"}};
  EXPECT_EQ(json_text(valid, -1), valid.dump());
}

TEST(JsonText, RefusesWhatIsIncompleteOrTooDeep) {
  EXPECT_EQ(parse_json("{\"a\": 1", "a.json").error().message, "a.json: is incomplete or not JSON");
  EXPECT_EQ(parse_json(std::string(1'000'000, '['), "a.json").error().message,
            "a.json: is nested more than 64 deep");
  EXPECT_TRUE(parse_json(std::string(60, '[') + std::string(60, ']'), "a.json"));
}

}  // namespace
}  // namespace aims
