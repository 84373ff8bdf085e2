// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/csv.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace aims {
namespace {

TEST(Csv, WritesHeaderAndRows) {
  CsvTable table({"name", "value", "count", "ok"});
  table.add("aims").add(0.1).add(3).add(true).end_row();
  table.add("lio").add(-2.0).add(std::int64_t{1} << 62).add(false).end_row();
  EXPECT_EQ(table.text(),
            "name,value,count,ok\naims,0.1,3,true\nlio,-2,4611686018427387904,false\n");
}

TEST(Csv, QuotesWhatNeedsIt) {
  CsvTable table({"a,b", "plain"});
  table.add("say \"hi\"").add("two\nlines").end_row();
  EXPECT_EQ(table.text(), "\"a,b\",plain\n\"say \"\"hi\"\"\",\"two\nlines\"\n");
}

TEST(Csv, LeavesCellsWithoutValueEmpty) {
  CsvTable table({"a", "b", "c", "d"});
  table.add(std::optional<double>()).add(std::numeric_limits<double>::quiet_NaN()).end_row();
  table.add_empty().add(std::optional<double>(1.5)).add_empty().add(2).end_row();
  EXPECT_EQ(table.text(), "a,b,c,d\n,,,\n,1.5,,2\n");
}

TEST(Csv, NumbersReadBackEqual) {
  for (const double value : {0.1, 1.0 / 3.0, 1e-300, 123456789.123456789, -0.0}) {
    CsvTable table({"v"});
    table.add(value).end_row();
    EXPECT_EQ(std::stod(table.text().substr(2)), value);
  }
}

}  // namespace
}  // namespace aims
