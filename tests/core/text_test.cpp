// SPDX-License-Identifier: BSD-3-Clause
#include "core/text.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

namespace aims {
namespace {

TEST(Text, KeepsValidUtf8) {
  const std::string text = "plain, \xC3\xA9, \xE2\x82\xAC, \xF0\x9F\x90\x95, \xEF\xBF\xBF";
  EXPECT_EQ(utf8_text(text), text);
  EXPECT_EQ(terminal_text(text), text);
  EXPECT_EQ(line_text(text), text);
}

TEST(Text, ShowsBytesThatAreNoUtf8) {
  EXPECT_EQ(utf8_text("a\xFFz"), "a\\xffz");
  EXPECT_EQ(utf8_text("caf\xE9"), "caf\\xe9");
  EXPECT_EQ(utf8_text("\xC0\xAF"), "\\xc0\\xaf") << "overlong";
  EXPECT_EQ(utf8_text("\xED\xA0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
  EXPECT_EQ(utf8_text("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "above U+10FFFF";
  EXPECT_EQ(utf8_text("\xE2\x82"), "\\xe2\\x82") << "cut short";
}

TEST(Text, ATerminalGetsNoCommand) {
  EXPECT_EQ(terminal_text("\x1b[2J\x07\r"), "\\x1b[2J\\x07\\x0d");
  EXPECT_EQ(terminal_text("\xC2\x9B"
                          "2J"),
            "\\xc2\\x9b2J")
      << "CSI as one character";
  EXPECT_EQ(terminal_text("a\tb\n"), "a\tb\n");
  EXPECT_EQ(utf8_text("\x1b\n"), "\x1b\n") << "JSON escapes these itself";
}

TEST(Text, AMessageIsOneLineOfBoundedLength) {
  EXPECT_EQ(line_text("x\ny\t"), "x\\x0ay\\x09");
  const std::string word(2'000'000, 'a');
  EXPECT_EQ(line_text("key: found '" + word + "'"),
            "key: found '" + std::string(79, 'a') + "... (2000002 bytes)");
  const std::string path(511, 'p');
  EXPECT_EQ(line_text(path), path);
  std::string words;
  while (words.size() < 100'000) words += "word ";
  const std::string shown = line_text("first " + words + "last");
  EXPECT_LT(shown.size(), 4100U);
  EXPECT_TRUE(shown.starts_with("first word"));
  EXPECT_TRUE(shown.ends_with("word last"));
}

TEST(Text, IsTrimmedOfBlanksAtItsEndsAlone) {
  EXPECT_EQ(trimmed("\t a b "), "a b");
  EXPECT_EQ(trimmed(" a\r", " \r"), "a");
  EXPECT_EQ(trimmed(" a\r"), "a\r");
  EXPECT_EQ(trimmed(" \t "), "");
}

TEST(Text, IsSplitWithoutAnEmptyLastPart) {
  EXPECT_EQ(split("a.b..c", '.'), (std::vector<std::string>{"a", "b", "", "c"}));
  EXPECT_EQ(split("a\nb\n", '\n'), (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(split("", ',').empty());
  std::string_view rest = "12x34";
  EXPECT_EQ(take_until(rest, 'x'), "12");
  EXPECT_EQ(rest, "34");
  EXPECT_EQ(take_until(rest, 'x'), "34");
  EXPECT_EQ(rest, "");
}

TEST(Text, OfANumberIsThatNumberAlone) {
  EXPECT_EQ(number_from<int>("-12"), -12);
  EXPECT_EQ(number_from<double>("1e-3"), 1e-3);
  for (const char* text : {"", " 1", "1 ", "+1", "1x", "300"}) {
    EXPECT_EQ(number_from<std::uint8_t>(text), std::nullopt) << text;
  }
}

TEST(Text, InLowerCaseKeepsWhatIsNoLetterOfAscii) {
  EXPECT_EQ(lower_case("IMU_Link[\xC3\x84]"), "imu_link[\xC3\x84]");
}

TEST(DecimalText, WhatRoundsToZeroHasNoSign) {
  EXPECT_EQ(decimal_text(-0.0, 0), "0");
  EXPECT_EQ(decimal_text(-0.004, 2), "0.00");
  EXPECT_EQ(decimal_text(-0.006, 2), "-0.01");
  EXPECT_EQ(decimal_text(-10.0, 0), "-10");
}

RC_GTEST_PROP(TextOfAnyBytes, IsValidAndOfAMessageOneLine, (const std::string& bytes)) {
  const std::string text = utf8_text(bytes);
  RC_ASSERT(utf8_text(text) == text);
  const std::string line = line_text(bytes);
  RC_ASSERT(utf8_text(line) == line);
  RC_ASSERT(std::none_of(line.begin(), line.end(), [](char c) { return c >= 0 && c < ' '; }));
}

}  // namespace
}  // namespace aims
