// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/drawn_groups.hpp"

#include <gtest/gtest.h>

#include "core/files/atomic_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

RunRecord run_of(std::uint64_t seed, const Json& drawn, double ate, bool valid = true) {
  RunRecord run;
  run.seed = seed;
  run.scores["drawn"] = drawn;
  run.scores["robot"] = {{"end", valid ? "route_done" : "fell"}, {"valid", valid}};
  if (!valid) run.scores["robot"]["invalid_reason"] = "the robot fell";
  run.scores["estimators"]["aims"] = {{"ate_m", ate}, {"success", valid && ate < 1.0}};
  return run;
}

/// ATE of 0.1 m per metre of width; 4 of 12 runs straight, one invalid; the widest fails.
StoredResults walks() {
  std::vector<RunRecord> runs;
  for (int i = 1; i <= 12; ++i) {
    const double angle = i <= 4 ? 0.0 : 10.0 * i;
    runs.push_back(
        run_of(static_cast<std::uint64_t>(i),
               {{"width", 1.0 * i}, {"angle", angle}, {"side", i % 3 ? "left" : "right"}}, 0.1 * i,
               i != 7));
  }
  return {{"walk", runs}};
}

TEST(DrawnGroups, NumbersFallIntoBinsOfEqualNumbersOfRuns) {
  const auto groups = group_by_drawn(walks(), "width", 4);
  ASSERT_TRUE(groups) << groups.error().message;
  ASSERT_EQ(groups->size(), 4U);
  EXPECT_EQ((*groups)[0].label, "1 to 3");
  EXPECT_EQ((*groups)[3].label, "10 to 12");
  EXPECT_EQ((*groups)[2].invalid, 1U) << "seed 7";
  const GroupScores& third = (*groups)[2].estimators.front();
  EXPECT_EQ(third.runs, 2U);
  EXPECT_EQ(third.successes, 2U);
  EXPECT_NEAR(*third.medians[1], 0.85, 1e-12) << "of 0.8 and 0.9 m";
  EXPECT_EQ((*groups)[3].estimators.front().successes, 0U) << "1.0 m and more is no success";
}

TEST(DrawnGroups, EqualValuesStayTogether) {
  const auto groups = group_by_drawn(walks(), "angle", 4);
  ASSERT_TRUE(groups);
  ASSERT_EQ(groups->size(), 4U);
  EXPECT_EQ((*groups)[0].label, "0");
}

TEST(DrawnGroups, TextsFormOneGroupEach) {
  const auto groups = group_by_drawn(walks(), "side", 4);
  ASSERT_TRUE(groups);
  ASSERT_EQ(groups->size(), 2U);
  EXPECT_EQ((*groups)[0].label, "left");
  EXPECT_EQ((*groups)[1].label, "right");
  EXPECT_FALSE((*groups)[0].low);
  EXPECT_EQ((*groups)[0].estimators.front().runs, 7U) << "8, one of them invalid";
  EXPECT_EQ((*groups)[1].estimators.front().runs, 4U);
}

TEST(DrawnGroups, FewValuesFormOneGroupEach) {
  std::vector<RunRecord> runs;
  for (std::uint64_t i = 0; i < 9; ++i) runs.push_back(run_of(i, {{"people", i % 3}}, 0.1));
  const auto groups = group_by_drawn({{"walk", runs}}, "people", 4);
  ASSERT_TRUE(groups);
  ASSERT_EQ(groups->size(), 3U);
  for (const DrawnGroup& each : *groups) EXPECT_EQ(each.estimators.front().runs, 3U) << each.label;
}

TEST(DrawnGroups, AKeyThatNobodyDrewIsAnError) {
  const auto groups = group_by_drawn(walks(), "widht", 4);
  ASSERT_FALSE(groups);
  EXPECT_NE(groups.error().message.find("did you mean 'width'"), std::string::npos);
  const auto none = group_by_drawn({{"walk", {RunRecord{}}}}, "width", 4);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("no run here drew"), std::string::npos);
}

TEST(DrawnGroups, FilesHoldWhatTheTableShows) {
  const TemporaryFolder folder;
  const auto groups = group_by_drawn(walks(), "width", 4);
  ASSERT_TRUE(write_groups(*groups, "width", "out/random", folder.path() / "by"));
  const Json json = Json::parse(*read_file(folder.path() / "by" / "groups.json"));
  EXPECT_EQ(json["schema"], "aims.groups/1");
  EXPECT_EQ(json["groups"].size(), 4U);
  EXPECT_EQ(groups_table(*groups).rows[2][3], "2/2 (34-100 %)");
  EXPECT_EQ(groups_table(*groups).rows[2][4], "-") << "older results know nothing of 1 %";
  EXPECT_EQ(json["groups"][0]["estimators"]["aims"]["median"]["ate_m"], 0.2);
  const std::string csv = *read_file(folder.path() / "by" / "groups.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
}

TEST(DrawnGroups, CountSuccessesAndMarkEstimatesThatLackAPart) {
  std::vector<RunRecord> runs;
  for (std::uint64_t i = 0; i < 4; ++i) {
    runs.push_back(run_of(i, {{"people", i % 2}}, 0.1));
    runs.back().scores["estimators"]["aims"]["success_1_percent"] = i == 0;
  }
  EXPECT_EQ(groups_legend(*group_by_drawn({{"walk", runs}}, "people", 4)), "");
  Json& stops = runs[3].scores["estimators"]["aims"];
  stops["success"] = false;
  stops["diverged_reason"] = "ends_early";
  const auto groups = group_by_drawn({{"walk", runs}}, "people", 4);
  ASSERT_TRUE(groups);
  const TextTable table = groups_table(*groups);
  EXPECT_EQ(table.rows[0][3], "2/2 (34-100 %)");
  EXPECT_EQ(table.rows[0][4], "1/2 (9-91 %)");
  EXPECT_EQ(table.rows[1][3], "1/2 (9-91 %)");
  const auto column = std::ranges::find(table.header, "ATE start [m]") - table.header.begin();
  ASSERT_LT(column, std::ssize(table.header)) << table.header.back();
  EXPECT_EQ(table.rows[0][static_cast<std::size_t>(column)], "0.100");
  EXPECT_EQ(table.rows[1][static_cast<std::size_t>(column)], "0.100 part");
  EXPECT_NE(groups_legend(*groups).find("part: "), std::string::npos);
  const TemporaryFolder folder;
  ASSERT_TRUE(write_groups(*groups, "people", "out/random", folder.path()));
  EXPECT_NE(read_file(folder.path() / "groups.md")->find("part: over the parts"),
            std::string::npos);
  const std::string csv = *read_file(folder.path() / "groups.csv");
  EXPECT_NE(csv.find("successes_1_percent,failed,partial,invalid"), std::string::npos) << csv;
  const Json json = groups_json(*groups, "people", "out/random");
  for (const std::size_t i : {0U, 1U}) {
    EXPECT_EQ(json["groups"][i]["estimators"]["aims"]["partial"], i == 1);
  }
}

}  // namespace
}  // namespace aims
