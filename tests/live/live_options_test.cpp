// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_options.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

TEST(LiveOptions, ParametersFillInMissingOptions) {
  auto command =
      parse_live_arguments({"--estimator", "lio", "--set", "a.b=1", "--tf"}, LiveNetwork::kRos1);
  ASSERT_TRUE(command) << command.error().message;
  const auto applied = apply_parameters({{"estimator", "leg"},
                                         {"out", "walk.tum"},
                                         {"settle", "1.5"},
                                         {"set/recording/topics/imu", "/imu"}},
                                        *command);
  ASSERT_TRUE(applied) << applied.error().message;
  EXPECT_EQ(command->options.estimator, "lio");
  EXPECT_EQ(command->options.out, "walk.tum");
  EXPECT_EQ(command->options.settle, 1.5);
  EXPECT_TRUE(command->options.tf);
  // Later ones win: the command line's come last.
  EXPECT_EQ(command->options.overrides,
            (std::vector<std::string>{"recording.topics.imu=/imu", "a.b=1"}));
}

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

TEST(LiveOptions, BadParametersNameThemselves) {
  LiveCommand command;
  const auto unknown = apply_parameters({{"estimater", "aims"}}, command);
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("~estimater"), std::string::npos);
  EXPECT_NE(unknown.error().message.find("did you mean 'estimator'"), std::string::npos);
  const auto wrong = apply_parameters({{"settle", "soon"}}, command);
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message.find("~settle"), std::string::npos);
}

}  // namespace
}  // namespace aims
