// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/table.hpp"

#include <gtest/gtest.h>

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

TEST(TextTable, WithoutColumnsIsEmptyText) {
  EXPECT_EQ(to_text({}), "");
  EXPECT_EQ(to_markdown({}), "");
}

}  // namespace
}  // namespace aims
