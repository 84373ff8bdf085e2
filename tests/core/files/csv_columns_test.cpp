// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/csv_columns.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/files/csv.hpp"

namespace aims {
namespace {

TEST(CsvColumns, ReadsWhatCsvTableWrites) {
  CsvTable table({"name", "x, in m", "flag"});
  table.add("plain").add(0.1).add(true).end_row();
  table.add("say \"so\",\nplease").add(1e-300).add(false).end_row();
  table.add("").end_row();
  const auto back = CsvColumns::parse(table.text(), "t.csv");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->rows(), 3U);
  EXPECT_EQ(back->texts("name"), (std::vector<std::string>{"plain", "say \"so\",\nplease", ""}));
  const auto x = back->numbers("x, in m");
  ASSERT_TRUE(x);
  EXPECT_EQ((*x)[0], 0.1);
  EXPECT_EQ((*x)[1], 1e-300);
  EXPECT_TRUE(std::isnan((*x)[2]));
  EXPECT_EQ((*back->numbers("flag"))[0], 1.0);
  EXPECT_EQ((*back->numbers("flag"))[1], 0.0);
}

TEST(CsvColumns, AMissingColumnHasNoNumbers) {
  const auto table = CsvColumns::parse("a\n1\n", "t.csv");
  ASSERT_TRUE(table);
  EXPECT_FALSE(table->has("b"));
  EXPECT_TRUE(table->numbers("b")->empty());
  EXPECT_TRUE(table->texts("b").empty());
}

TEST(CsvColumns, NamesTheLineOfATruncatedRowAndOfAnInvalidNumber) {
  const auto refused = [](const std::string& text, const std::string& expected) {
    const auto table = CsvColumns::parse(text, "t.csv");
    const auto numbers = table ? table->numbers("a") : Result<std::vector<double>>();
    const Error error = table ? numbers ? Error{} : numbers.error() : table.error();
    EXPECT_NE(error.message.find(expected), std::string::npos) << error.message;
  };
  refused("", "t.csv:1");
  refused("a,b", "t.csv:1");
  refused("a,b\n1,2\n3", "t.csv:3: expected 2 cells");
  refused("a,b\n1,2\n3,4", "t.csv:3: expected 2 cells and a line end, found 2 cells, truncated");
  refused("a,b\n1\n", "t.csv:2: expected 2 cells");
  refused("a,b\n\"1\n2\",3\n\"open,4\n", "t.csv:4");
  refused("a,b\n\"x\ny\",3\n", "t.csv:2: a: expected a number");
}

TEST(CsvColumns, AcceptsCarriageReturns) {
  const auto table = CsvColumns::parse("a,b\r\n1,2\r\n", "t.csv");
  ASSERT_TRUE(table);
  EXPECT_EQ(*table->numbers("b"), std::vector<double>{2.0});
}

TEST(CsvColumns, ReadsDecimalCommasWhereTheySeparateNoCells) {
  for (const std::string text :
       {"t;x;name\n0,5;-1,25e2;a,b\n", "t\tx\tname\n0,5\t-1,25e2\ta,b\n"}) {
    const auto csv = CsvColumns::parse(text, "c", {}, CsvOrigin::kForeign);
    ASSERT_TRUE(csv) << csv.error().message;
    EXPECT_EQ(csv->numbers("t").value(), std::vector<double>{0.5});
    EXPECT_EQ(csv->numbers("x").value(), std::vector<double>{-125.0});
    EXPECT_EQ(csv->texts("name"), std::vector<std::string>{"a,b"});
  }
}

TEST(CsvColumns, KeepsTheCarriageReturnOfAQuotedCell) {
  const auto table = CsvColumns::parse("a,\"b\r\"\r\n1,\"\r\"\n", "t.csv");
  ASSERT_TRUE(table);
  EXPECT_EQ(table->header(), (std::vector<std::string>{"a", "b\r"}));
  EXPECT_EQ(table->texts("b\r"), std::vector<std::string>{"\r"});
}

TEST(CsvColumns, LeavesOutTheColumnsThatAreNotAskedFor) {
  const std::vector<std::string> only = {"c", "a", "none"};
  const auto table = CsvColumns::parse("a,b,c\n1,\"x,\"\"y\",\n2,,7\n", "t.csv", only);
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_EQ(table->header(), (std::vector<std::string>{"a", "c"}));
  EXPECT_FALSE(table->has("b"));
  EXPECT_EQ(table->rows(), 2U);
  EXPECT_EQ(table->texts("a"), (std::vector<std::string>{"1", "2"}));
  EXPECT_EQ(table->texts("c"), (std::vector<std::string>{"", "7"}));
  EXPECT_FALSE(CsvColumns::parse("a,b\n1\n", "t.csv", only)) << "a cell of a column left out";
}

}  // namespace
}  // namespace aims
