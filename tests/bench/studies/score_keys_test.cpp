// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenario/score_keys.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "bench/scoring/score_list.hpp"
#include "tests/bench/studies/short_walk.hpp"

namespace aims {
namespace {

std::set<std::string> without(std::vector<std::string> keys, const char* prefix) {
  std::erase_if(keys, [&](const std::string& key) { return key.starts_with(prefix); });
  return {keys.begin(), keys.end()};
}

TEST(ScoreKeys, AreThoseOfARealRun) {
  const TemporaryFolder folder;
  Scenario scenario = test::short_walk();
  scenario.run = {"aims"};
  scenario.simulation.route.points.back().x = 2.0;  // beyond scoring.min_segment_length
  SuiteOptions options = test::options_for(folder.path());
  options.seeds = {1};
  const auto suite = run_suite({{"short_walk.yaml", scenario}}, options, test::keep_going);
  ASSERT_TRUE(suite) << suite.error().message;
  const RunRecord& run = suite->cases.at(0).runs.at(0);
  std::vector<std::string> possible = possible_score_keys(scenario);
  EXPECT_TRUE(std::ranges::find(possible, "optimized.ate_m") != possible.end());
  EXPECT_EQ(without(possible, "optimized."), without(score_keys(run, "aims"), "counts."));
}

TEST(ScoreKeys, OfTheRunItselfAreThoseOfARealRun) {
  const TemporaryFolder folder;
  Scenario scenario = test::short_walk();
  scenario.run = {"leg"};
  SuiteOptions options = test::options_for(folder.path());
  options.seeds = {1};
  const auto suite = run_suite({{"short_walk.yaml", scenario}}, options, test::keep_going);
  ASSERT_TRUE(suite) << suite.error().message;
  EXPECT_EQ(possible_run_score_keys(scenario), run_score_keys(suite->cases.at(0).runs.at(0)));
  EXPECT_TRUE(check_run_score("it", "robot.fell", scenario));
  EXPECT_FALSE(check_run_score("it", "robot.feld", scenario));
  EXPECT_FALSE(check_run_score("it", "ate_m", scenario)) << "of which estimator?";
}

TEST(ScoreKeys, FollowTheSegmentsOfTheScenario) {
  Scenario scenario = test::short_walk();
  EXPECT_TRUE(check_score("it", "m_list_signed_percent.a-b", scenario));
  EXPECT_TRUE(check_score("it", "counts.lidar.no_update", scenario));
  const auto unknown = check_score("it", "m_list_percent.b-a", scenario);
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("it: no score 'm_list_percent.b-a'"), std::string::npos);
  scenario.simulation.route.points.push_back({"a", 0.0, 0.0});
  EXPECT_TRUE(check_score("it", "m_list_percent.b-a", scenario));
  scenario.scoring.segments = {"a-b"};
  EXPECT_FALSE(check_score("it", "m_list_percent.b-a", scenario));
}

/// The unit that the last part of a key ends with; none where it names none.
std::string named_unit(const std::string& key) {
  static const std::vector<std::pair<std::string, std::string>> kEndings = {
      {"_percent", "%"}, {"_deg_per_m", "deg/m"}, {"_ms", "ms"},  {"_m", "m"},
      {"_s", "s"},       {"_mrad", "mrad"},       {"_rad", "rad"}};
  const auto found =
      std::ranges::find_if(kEndings, [&](const auto& each) { return key.ends_with(each.first); });
  return found == kEndings.end() ? "" : found->second;
}

TEST(ScoreList, HasEveryScoreOfARunInTheUnitThatItsKeyNames) {
  for (const Score& score : score_list()) {
    EXPECT_EQ(&score_at(score.key), &score) << "a key above it comes first";
  }
  for (const std::string& key : possible_score_keys(test::short_walk())) {
    if (key.ends_with("success_1_percent")) continue;  // its limit
    const std::string named = named_unit(key);
    if (!named.empty()) {
      EXPECT_EQ(unit_of(key), named) << key;
    }
    EXPECT_TRUE(std::ranges::any_of(score_list(), [&](const Score& each) {
      return &each == &score_at(key);
    })) << key;
  }
}

}  // namespace
}  // namespace aims
