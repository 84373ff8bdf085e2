// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/table.hpp"

#include <gtest/gtest.h>

#include <array>

namespace aims {
namespace {

const TextTable kTable = {{"name", "m"}, {{"aims", "0.1"}, {"tfs_clean", "12.3"}}};

TEST(TextTable, ColumnsAlignUnderTheirHeaders) {
  EXPECT_EQ(to_text(kTable),
            "name          m\n"
            "---------------\n"
            "aims        0.1\n"
            "tfs_clean  12.3\n");
}

TEST(TextTable, MarkdownHasOneCellPerColumn) {
  EXPECT_EQ(to_markdown(kTable),
            "| name | m |\n|---|---:|\n| aims | 0.1 |\n| tfs_clean | 12.3 |\n");
}

TEST(TextTable, LeavesOutTheLeastColumnsWhereItIsTooWide) {
  const TextTable wide = {{"name", "ATE m", "heading mrad", "RPE %"},
                          {{"aims", "0.1", "2.3", "1"}}};
  constexpr std::array kLeast = {"heading", "RPE", "name"};
  std::vector<std::string> left_out;
  EXPECT_EQ(narrowed(wide, 80, kLeast, left_out).header.size(), 4U);
  EXPECT_TRUE(left_out.empty());
  const TextTable narrow = narrowed(wide, 20, kLeast, left_out);
  EXPECT_EQ(narrow.header, (std::vector<std::string>{"name", "ATE m", "RPE %"}));
  EXPECT_EQ(narrow.rows[0], (std::vector<std::string>{"aims", "0.1", "1"}));
  EXPECT_EQ(left_out, (std::vector<std::string>{"heading mrad"}));
  EXPECT_EQ(narrowed(wide, 1, kLeast, left_out).header, (std::vector<std::string>{"name", "ATE m"}))
      << "the first column stays";
}

TEST(TextTable, WithoutColumnsIsEmptyText) {
  EXPECT_EQ(to_text({}), "");
  EXPECT_EQ(to_markdown({}), "");
}

}  // namespace
}  // namespace aims
