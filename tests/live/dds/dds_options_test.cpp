// SPDX-License-Identifier: BSD-3-Clause
#include "live/dds/dds_options.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

#include "live/program.hpp"

namespace aims {
namespace {

/// The domain that a program with these arguments uses; none: it ends with exit code 2.
std::optional<std::uint32_t> domain_of(const std::vector<std::string>& arguments,
                                       const char* environment) {
  environment == nullptr ? unsetenv("ROS_DOMAIN_ID") : setenv("ROS_DOMAIN_ID", environment, 1);
  CLI::App app("", "program");
  DdsOptions options;
  add_domain_option(app, options);
  testing::internal::CaptureStderr();
  const int exit_code = run_program(app, arguments, [] { return Result<void>(); });
  const std::string said = testing::internal::GetCapturedStderr();
  unsetenv("ROS_DOMAIN_ID");
  if (exit_code == 0) return options.domain;
  EXPECT_EQ(exit_code, 2);
  EXPECT_NE(said.find("ROS_DOMAIN_ID"), std::string::npos) << said;
  EXPECT_EQ(said.find('\n'), said.size() - 1) << "one line: " << said;
  return std::nullopt;
}

TEST(DdsOptions, TheDomainIsThatOfTheEnvironmentUnlessItIsGiven) {
  EXPECT_EQ(domain_of({}, nullptr), 0U);
  EXPECT_EQ(domain_of({}, ""), 0U);
  EXPECT_EQ(domain_of({}, "42"), 42U);
  EXPECT_EQ(domain_of({"--domain", "7"}, "42"), 7U);
}

TEST(DdsOptions, NoNumberFrom0To232IsAnError) {
  for (const char* wrong : {"233", "-1", "x", "4 "}) EXPECT_FALSE(domain_of({}, wrong)) << wrong;
  EXPECT_FALSE(domain_of({"--domain", "233"}, nullptr));
}

TEST(DdsOptions, ANodeNameFitsATopicOfDds) {
  for (const auto& [length, code] : {std::pair(200, 0), std::pair(201, 2)}) {
    CLI::App app("", "program");
    DdsOptions options;
    add_node_option(app, options, "");
    testing::internal::CaptureStderr();
    const std::string name(static_cast<std::size_t>(length), 'a');
    EXPECT_EQ(run_program(app, {"--node", name}, [] { return Result<void>(); }), code);
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_EQ(said.find("letters, digits, _ and /") != std::string::npos, code != 0) << said;
  }
}

}  // namespace
}  // namespace aims
