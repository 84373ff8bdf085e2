// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_config.hpp"

#include <gtest/gtest.h>

#include "live/program.hpp"

namespace aims {
namespace {

/// Exit code and what was printed, of arguments that are no error to a program that fails.
std::pair<int, std::string> run(const std::vector<std::string>& arguments) {
  CLI::App app("", "program");
  LiveOptions options;
  add_live_options(app, options);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int exit_code =
      run_program(app, arguments, []() -> Result<void> { return failure("why"); });
  return {exit_code,
          testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr()};
}

TEST(LiveOptions, HelpIsPrinted) {
  const auto [exit_code, said] = run({"--help"});
  EXPECT_EQ(exit_code, 0);
  EXPECT_NE(said.find("--patience"), std::string::npos);
}

TEST(LiveOptions, BadArgumentsAreOneLine) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--fast"}, {"--settle", "0"}, {"--odom-frame", ""}, {"stray"}}) {
    const auto [exit_code, said] = run(arguments);
    EXPECT_EQ(exit_code, 2);
    EXPECT_TRUE(said.ends_with("; see --help\n")) << said;
    EXPECT_EQ(said.find('\n'), said.size() - 1) << said;
  }
}

TEST(LiveOptions, AnErrorOfTheProgramIsALineAndAnExitCode) {
  EXPECT_EQ(run({"--settle", "1"}), std::pair(2, std::string("program: why\n")));
}

}  // namespace
}  // namespace aims
