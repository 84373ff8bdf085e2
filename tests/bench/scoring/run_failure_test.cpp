// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/run_failure.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

TEST(RunFailure, IsOneItemOfMarkdownWithTheFirstLineOfItsMessage) {
  const RunFailure failure{"walk", 3, "mine", "add_legs: ValueError: a|b <c>\nsecond\nthird"};
  EXPECT_EQ(markdown_item(failure), "- walk seed 3 mine: add_legs: ValueError: a\\|b \\<c\\>\n");
  EXPECT_EQ(text_of(failure), "walk seed 3 mine: add_legs: ValueError: a|b <c>\nsecond\nthird");
}

TEST(RunFailure, OfTwoEstimatorsWithOneMessageStaysOneEach) {
  const std::vector<RunFailure> failures = {
      {"walk", 3, "a", "killed"}, {"walk", 3, "b", "killed"}, {"walk", 4, "b", "killed"}};
  EXPECT_EQ(markdown_list(failures), "- walk seed 3 a, b: killed\n- walk seed 4 b: killed\n");
  EXPECT_EQ(failures_json(failures)[1]["estimator"], "b");
}

TEST(RunFailure, OfAScenarioThatDoesNotLoadHasNoSeed) {
  const RunFailure failure{"broken", std::nullopt, "", "broken.yaml:1: no"};
  EXPECT_EQ(markdown_item(failure), "- broken: broken.yaml:1: no\n");
  EXPECT_TRUE(failures_json({&failure, 1})[0]["seed"].is_null());
}

}  // namespace
}  // namespace aims
