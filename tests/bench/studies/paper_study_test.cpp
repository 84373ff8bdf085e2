// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/paper_study.hpp"

#include <gtest/gtest.h>

#include <map>
#include <stdexcept>

#include "core/files/atomic_file.hpp"
#include "estimator/registry.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

/// A run of the corridor in which each estimator has that M_end [m]; none: no value.
RunRecord run_of(std::uint64_t seed, const std::map<std::string, std::optional<double>>& m_end,
                 bool valid = true) {
  RunRecord run;
  run.seed = seed;
  run.scores["robot"] = {{"end", valid ? "route_done" : "fell"}, {"valid", valid}};
  if (!valid) run.scores["robot"]["invalid_reason"] = "the robot fell";
  for (const auto& [name, value] : m_end) {
    run.scores["estimators"][name] = {{"m_end_m", json_of(value)},
                                      {"m_list_percent", {{"a-b", 0.1}, {"b-a", 0.1}}},
                                      {"success", value.has_value()}};
  }
  return run;
}

Suite suite_of(std::vector<RunRecord> runs) {
  Suite suite;
  SuiteCase each;
  each.scenario.name = "corridor";
  each.runs = std::move(runs);
  suite.cases.push_back(std::move(each));
  return suite;
}

const PaperSystem& system_in(const PaperExperiment& experiment, const std::string& name) {
  for (const PaperSystem& each : experiment.systems) {
    if (each.estimator == name) return each;
  }
  throw std::runtime_error("no system " + name);
}

/// M_end is the third column of the corridor's table.
constexpr std::size_t kEnd = 2;

TEST(PaperStudy, TablesAreThoseOfThePaper) {
  for (const PaperTable& table : paper_tables()) {
    ASSERT_EQ(table.methods.size(), 11U);
    for (const PaperMethod& method : table.methods) {
      EXPECT_EQ(method.figures.size(), table.scores.size()) << method.estimator;
    }
  }
  EXPECT_EQ(paper_table_of("corridor")->methods.front().figures[kEnd], 16.32);
  EXPECT_EQ(paper_table_of("garage")->methods[7].figures[4], 0.29);
  EXPECT_EQ(paper_table_of("junction"), nullptr);
}

TEST(PaperStudy, EveryComparedSystemCanRun) {
  for (const std::string& name : paper_estimators()) {
    EXPECT_TRUE(check_estimator_name(name)) << name;
  }
}

TEST(PaperStudy, TheSameOrderHasATauOfOne) {
  const auto study = paper_study(suite_of({run_of(
      1, {{"aims", 0.01}, {"fast_lio2", 0.02}, {"leg", 5.0}, {"loam", 8.0}, {"lio_sam", {}}})}));
  ASSERT_TRUE(study) << study.error().message;
  const PaperOrder& order = study->front().orders[kEnd];
  EXPECT_EQ(order.systems, 5U);
  EXPECT_DOUBLE_EQ(order.tau.value(), 1.0);
}

TEST(PaperStudy, TheOppositeOrderHasATauOfMinusOne) {
  const auto study = paper_study(
      suite_of({run_of(1, {{"aims", 9.0}, {"fast_lio2", 8.0}, {"leg", 5.0}, {"loam", 1.0}})}));
  ASSERT_TRUE(study);
  EXPECT_DOUBLE_EQ(study->front().orders[kEnd].tau.value(), -1.0);
}

TEST(PaperStudy, SystemsOutsideThePaperDoNotCountInTheOrder) {
  const auto study =
      paper_study(suite_of({run_of(1, {{"aims", 0.1}, {"aims_d", 9.0}, {"fast_lio2", 0.2}})}));
  ASSERT_TRUE(study);
  EXPECT_EQ(study->front().orders[kEnd].systems, 2U);
  EXPECT_FALSE(system_in(study->front(), "aims_d").cells[kEnd].figure);
}

TEST(PaperStudy, ASystemWithoutAValueInMostRunsHasNoMedianAndIsLast) {
  const auto study = paper_study(suite_of({run_of(1, {{"aims", 0.2}, {"lego_loam", 0.1}}),
                                           run_of(2, {{"aims", 0.2}, {"lego_loam", {}}}),
                                           run_of(3, {{"aims", 0.4}, {"lego_loam", {}}})}));
  ASSERT_TRUE(study);
  const PaperCell& lost = system_in(study->front(), "lego_loam").cells[kEnd];
  EXPECT_FALSE(lost.median);
  EXPECT_EQ(system_in(study->front(), "lego_loam").successes, 1U);
  EXPECT_DOUBLE_EQ(system_in(study->front(), "aims").cells[kEnd].median.value(), 0.2);
  EXPECT_DOUBLE_EQ(system_in(study->front(), "aims").cells[kEnd].worst.value(), 0.4);
  EXPECT_DOUBLE_EQ(study->front().orders[kEnd].tau.value(), 1.0) << "0.16 before 0.79 in the paper";
}

TEST(PaperStudy, TheIntervalOfTauCoversOrdersThatSeedsDisagreeOn) {
  std::vector<RunRecord> runs;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const double aims = seed % 2 == 0 ? 0.1 : 0.3;
    runs.push_back(run_of(seed, {{"aims", aims}, {"fast_lio2", 0.2 + 0.001 * seed}}));
  }
  const auto study = paper_study(suite_of(runs));
  ASSERT_TRUE(study);
  const Interval& interval = study->front().orders[kEnd].interval;
  EXPECT_DOUBLE_EQ(interval.low.value(), -1.0);
  EXPECT_DOUBLE_EQ(interval.high.value(), 1.0);
}

TEST(PaperStudy, InvalidRunsAreLeftOut) {
  const auto study =
      paper_study(suite_of({run_of(1, {{"aims", 0.2}}), run_of(2, {{"aims", 90.0}}, false)}));
  ASSERT_TRUE(study);
  EXPECT_EQ(study->front().seeds, std::vector<std::uint64_t>{1});
  EXPECT_DOUBLE_EQ(system_in(study->front(), "aims").cells[kEnd].worst.value(), 0.2);
}

TEST(PaperStudy, OtherScenariosAreAnError) {
  Suite suite = suite_of({run_of(1, {{"aims", 0.2}})});
  suite.cases.front().scenario.name = "severity_3";
  EXPECT_FALSE(paper_study(suite));
}

TEST(PaperStudy, WritesItsFiles) {
  const TemporaryFolder folder;
  const Suite suite = suite_of({run_of(1, {{"aims", 0.2}, {"loam", 3.0}})});
  const auto study = paper_study(suite);
  ASSERT_TRUE(study);
  ASSERT_TRUE(write_paper(*study, suite, folder.path()));
  const auto json = read_file(folder.path() / "paper.json");
  ASSERT_TRUE(json);
  const Json read = Json::parse(*json);
  EXPECT_EQ(read["schema"], "aims.paper/1");
  EXPECT_EQ(read["experiments"][0]["columns"][kEnd]["tau"], 1.0);
  const auto text = read_file(folder.path() / "paper.md");
  ASSERT_TRUE(text);
  EXPECT_NE(text->find("16.32 · 3.00 (3.00)"), std::string::npos) << *text;
}

}  // namespace
}  // namespace aims
