// SPDX-License-Identifier: BSD-3-Clause
#include "core/file_name.hpp"

#include <gtest/gtest.h>

#include <string>

namespace aims {
namespace {

TEST(FileName, OrdinaryNamesPass) {
  for (const char* name : {"corridor", "severity_3", "my walk", "no_ground-2", "größe", "a.b"}) {
    EXPECT_TRUE(check_file_name("name", name)) << name;
  }
  EXPECT_TRUE(check_file_name("name", std::string(kMaxNameLength, 'x')));
}

TEST(FileName, WhatLeavesTheFolderOrConfusesAShellIsRefused) {
  const std::string null("a\0b", 3);
  for (const std::string& name :
       {std::string("../../evil"), std::string("/tmp/evil"), std::string("a/b"),
        std::string("a\\b"), std::string(".."), std::string("."), std::string(".hidden"),
        std::string("-rf"), std::string("a..b"), std::string("a\nb"), std::string("\x1b[2J"), null,
        std::string("a\x7f"), std::string(), std::string(kMaxNameLength + 1, 'x')}) {
    const auto checked = check_file_name("name", name);
    ASSERT_FALSE(checked) << name;
    EXPECT_EQ(checked.error().message.rfind("name: expected a name", 0), 0U);
    for (const char c : checked.error().message) EXPECT_GE(static_cast<unsigned char>(c), 0x20);
    EXPECT_LT(checked.error().message.size(), 200U);
  }
}

}  // namespace
}  // namespace aims
