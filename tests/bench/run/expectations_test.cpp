// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/expectations.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

RunRecord record() {
  RunRecord run;
  run.seed = 7;
  run.scores["estimators"]["aims"] = {
      {"m_end_m", 0.15}, {"ate_m", nullptr}, {"m_list_percent", {{"a-b", 0.07}}}};
  return run;
}

Scenario expecting(const Expectation& expectation) {
  Scenario scenario;
  scenario.name = "corridor";
  scenario.expect = {expectation};
  return scenario;
}

RunRecord run_of(std::uint64_t seed, const Json& scores) {
  RunRecord run;
  run.seed = seed;
  run.scores["estimators"]["aims"] = scores;
  return run;
}

const std::vector<RunRecord> kThree = {run_of(1, {{"ate_m", 0.1}, {"success", true}}),
                                       run_of(2, {{"ate_m", 0.6}, {"success", false}}),
                                       run_of(3, {{"ate_m", 0.2}, {"success", true}})};

ExpectationCheck check(const Expectation& expectation, std::span<const RunRecord> runs) {
  return check_expectations(expecting(expectation), runs).at(0);
}

ExpectationCheck check(const Expectation& expectation) {
  const RunRecord run = record();
  return check(expectation, {&run, 1});
}

TEST(Expectations, HoldWhenTheScoreIsWithinItsLimit) {
  EXPECT_TRUE(check({"aims", "m_end_m", 0.2}).holds);
  EXPECT_TRUE(check({"aims", "m_list_percent.a-b", 0.07}).holds);
  EXPECT_TRUE(check({"aims", "m_end_m", kNoLimit, 0.1}).holds);
}

TEST(Expectations, FailWithScenarioSeedFigureAndLimit) {
  const Scenario scenario = expecting({"aims", "m_end_m", 0.1});
  const RunRecord run = record();
  const auto failures = failed(check_expectations(scenario, {&run, 1}));
  ASSERT_EQ(failures.size(), 1U);
  EXPECT_EQ(text_of(scenario, failures.front()),
            "corridor seed 7: aims m_end_m = 0.15, expected at most 0.1");
}

TEST(Expectations, FailWhereAnErrorIsSmallerThanItMustBe) {
  const ExpectationCheck easy = check({"aims", "m_end_m", kNoLimit, 1.0});
  EXPECT_FALSE(easy.holds);
  EXPECT_EQ(text_of(expecting(easy.expectation), easy),
            "corridor seed 7: aims m_end_m = 0.15, expected at least 1");
}

TEST(Expectations, FailWhereThereIsNoValue) {
  EXPECT_FALSE(check({"aims", "ate_m", 0.1}).holds);
  EXPECT_FALSE(check({"aims", "no_such_score", 0.1}).holds);
  EXPECT_FALSE(check({"aims", "ate_m", kNoLimit, 0.1}).holds) << "nothing is not much";
}

TEST(Expectations, DoNotCountForEstimatorsThatDidNotRun) {
  Scenario scenario = expecting({"lio", "m_end_m", 0.1});
  scenario.run = {"aims"};
  EXPECT_TRUE(check_expectations(scenario, kThree).empty());
}

TEST(Expectations, TakeTheWorstSeedUnlessAskedOtherwise) {
  const ExpectationCheck above = check({"aims", "ate_m", 0.5}, kThree);
  EXPECT_FALSE(above.holds);
  EXPECT_EQ(above.value, 0.6);
  EXPECT_EQ(above.seeds, std::vector<std::uint64_t>({2}));
  const ExpectationCheck below = check({"aims", "ate_m", kNoLimit, 0.15}, kThree);
  EXPECT_FALSE(below.holds);
  EXPECT_EQ(below.seeds, std::vector<std::uint64_t>({1}));
}

TEST(Expectations, TakeMedianAndMeanOverAllSeeds) {
  const ExpectationCheck median = check({"aims", "ate_m", 0.2, 0.2, ExpectationStatistic::kMedian}, kThree);
  EXPECT_TRUE(median.holds);
  EXPECT_EQ(median.seeds.size(), 3U);
  const ExpectationCheck rate = check({"aims", "success", kNoLimit, 0.8, ExpectationStatistic::kMean}, kThree);
  EXPECT_FALSE(rate.holds);
  EXPECT_NEAR(*rate.value, 2.0 / 3.0, 1e-12);
  EXPECT_NE(text_of(expecting(rate.expectation), rate).find("mean success = 0.6667"),
            std::string::npos);
}

// A failed run is a lost success; the error of a part of a run is none of the run.
TEST(Expectations, OfRunsThatFailedOrLackAPart) {
  std::vector<RunRecord> runs = kThree;
  runs[1].scores["estimators"] = Json::object();
  runs[1].scores["failures"] = {{{"estimator", "aims"}, {"message", "boom"}}};
  const auto success =
      check({"aims", "success", kNoLimit, 0.6, ExpectationStatistic::kMean}, runs);
  EXPECT_TRUE(success.holds);
  EXPECT_NEAR(*success.value, 2.0 / 3.0, 1e-12);
  runs[1] = kThree[1];
  runs[1].scores["estimators"]["aims"]["partial"] = true;
  EXPECT_FALSE(check({"aims", "ate_m", 10.0}, runs).value);
  EXPECT_TRUE(check({"aims", "ate_m", 10.0}, kThree).holds);
}

TEST(Expectations, NameTheSeedsWithoutAValue) {
  std::vector<RunRecord> runs = kThree;
  runs[2].scores["estimators"]["aims"]["ate_m"] = nullptr;
  const ExpectationCheck lost = check({"aims", "ate_m", 9.0, -kNoLimit, ExpectationStatistic::kMedian}, runs);
  EXPECT_FALSE(lost.holds);
  EXPECT_EQ(lost.seeds, std::vector<std::uint64_t>({3}));
}

TEST(Expectations, SayHowToRepeatThemWithTheSettingsGiven) {
  Scenario scenario = expecting({"aims", "ate_m", 0.5});
  scenario.file = "my scenarios/paper/corridor.yaml";
  scenario.overrides = {"run=[aims]", "lidar.range_max=9", "scene.kind=it's"};
  EXPECT_EQ(reproducing_command(scenario, check_expectations(scenario, kThree).at(0)),
            "aims run 'my scenarios/paper/corridor.yaml' --seeds 2 --estimators aims "
            "--set lidar.range_max=9 --set 'scene.kind=it'\\''s'");
}

TEST(Expectations, WithoutALimitOrWithImpossibleOnesAreRefused) {
  const TemporaryFolder folder;
  const auto load = [&](const char* expect) {
    std::ofstream(folder.path() / "s.yaml") << "expect: [{estimator: aims, score: ate_m" << expect;
    return load_scenario(folder.path() / "s.yaml", {});
  };
  EXPECT_TRUE(load(", max: 1}]"));
  EXPECT_TRUE(load(", min: 1, statistic: median}]"));
  EXPECT_FALSE(load("}]"));
  EXPECT_FALSE(load(", min: 2, max: 1}]"));
  EXPECT_FALSE(load(", max: 1, statistic: best}]"));
}

}  // namespace
}  // namespace aims
