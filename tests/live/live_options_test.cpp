// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_options.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

TEST(LiveOptions, HelpIsReturned) {
  const auto command = parse_live_arguments({"--help"}, LiveNetwork::kDds);
  ASSERT_TRUE(command);
  EXPECT_NE(command->help.find("--patience"), std::string::npos);
}

TEST(LiveOptions, BadArgumentsAreOneLine) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--fast"}, {"--settle", "0"}, {"stray"}}) {
    const auto command = parse_live_arguments(arguments, LiveNetwork::kDds);
    ASSERT_FALSE(command) << arguments.front();
    EXPECT_EQ(command.error().message.find('\n'), std::string::npos) << command.error().message;
  }
}

}  // namespace
}  // namespace aims
