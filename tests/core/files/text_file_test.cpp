// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/text_file.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

using namespace std::string_literals;

std::string error_of(const std::string& bytes) {
  const auto text = utf8_of(bytes, "f.txt");
  return text ? "" : text.error().message;
}

// Code units as the Unicode standard lists them, chapter 3.9: U+004D, U+0430, U+4E8C, U+10302.
TEST(TextFile, Utf16OfEitherByteOrderBecomesUtf8) {
  const std::string utf8 = "\x4d\xd0\xb0\xe4\xba\x8c\xf0\x90\x8c\x82";
  EXPECT_EQ(utf8_of("\xff\xfe\x4d\x00\x30\x04\x8c\x4e\x00\xd8\x02\xdf"s, "f.txt"), utf8);
  EXPECT_EQ(utf8_of("\xfe\xff\x00\x4d\x04\x30\x4e\x8c\xd8\x00\xdf\x02"s, "f.txt"), utf8);
}

TEST(TextFile, OtherTextIsAsItIs) {
  for (const std::string& text : {""s, "1 2 3\n"s, "\xef\xbb\xbf\x31\n"s, "a\0b"s}) {
    EXPECT_EQ(utf8_of(text, "f.txt"), text);
  }
}

TEST(TextFile, WhatIsNoTextIsOneErrorWithItsEncoding) {
  EXPECT_NE(error_of("\xff\xfe\x00\xd8\x41\x00"s).find("f.txt: damaged UTF-16"), std::string::npos);
  EXPECT_NE(error_of("\xff\xfe\x00\xdc"s).find("damaged UTF-16"), std::string::npos);
  EXPECT_NE(error_of("\xff\xfe\x41"s).find("damaged UTF-16"), std::string::npos);
  EXPECT_NE(error_of("\xff\xfe\0\0\x41\0\0\0"s).find("found UTF-32"), std::string::npos);
  EXPECT_NE(error_of("1\0 \0\x32\0\n\0"s).find("UTF-16 without a byte order mark"),
            std::string::npos);
}

}  // namespace
}  // namespace aims
