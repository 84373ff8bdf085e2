// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/waypoint_times.hpp"

#include <gtest/gtest.h>

#include "core/files/csv.hpp"

namespace aims {
namespace {

std::string message_of(std::string_view text) {
  const auto parsed = parse_waypoint_times(text, "p.csv");
  return parsed ? "" : parsed.error().message;
}

TEST(WaypointTimes, RowsAreReadInOrder) {
  const auto waypoint_times =
      parse_waypoint_times("point,stamp_s\r\na,2.5\r\n\"b, \"\"far\"\"\",2.5\n\nc,1e2\n", "p.csv");
  ASSERT_TRUE(waypoint_times) << waypoint_times.error().message;
  ASSERT_EQ(waypoint_times->size(), 3U);
  EXPECT_EQ((*waypoint_times)[0].point, "a");
  EXPECT_EQ((*waypoint_times)[0].stamp, 2'500'000'000);
  EXPECT_EQ((*waypoint_times)[1].point, "b, \"far\"");
  EXPECT_EQ((*waypoint_times)[2].stamp, 100 * kSecond);
}

TEST(WaypointTimes, NamesOfAnyTextComeBack) {
  const std::vector<WaypointTime> written = {
      {"b\"\n", 1 * kSecond}, {"\n\n# c,\"", 2 * kSecond}, {"a\r\nb", 3 * kSecond}};
  CsvTable table({"point", "stamp_s"});
  for (const WaypointTime& each : written) {
    table.add(each.point).add(to_seconds(each.stamp)).end_row();
  }
  const auto read = parse_waypoint_times(table.text(), "p.csv");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    EXPECT_EQ((*read)[i].point, written[i].point);
    EXPECT_EQ((*read)[i].stamp, written[i].stamp);
  }
  EXPECT_EQ(message_of("point,stamp_s\n\"a\nb\",1\nc,x\n").substr(0, 8), "p.csv:4:");
}

TEST(WaypointTimes, ErrorsNameFileAndLine) {
  EXPECT_EQ(message_of(""), "p.csv:1: expected the header 'point,stamp_s'");
  EXPECT_EQ(message_of("a,1\n"), "p.csv:1: expected the header 'point,stamp_s', found 'a,1'");
  EXPECT_EQ(message_of("point,stamp_s\na\n"),
            "p.csv:2: expected a point and its stamp in seconds, as a,12.5; found 'a'");
  EXPECT_NE(message_of("point,stamp_s\na,x\n").find("p.csv:2:"), std::string::npos);
  EXPECT_NE(message_of("point,stamp_s\n\"a,1\n").find("p.csv:2:"), std::string::npos);
  EXPECT_EQ(message_of("point,stamp_s\na,2\nb,1\n"),
            "p.csv:3: expected a stamp not before 2.000000000, found 1.000000000");
}

}  // namespace
}  // namespace aims
