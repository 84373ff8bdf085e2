// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/validity.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/run/expectations.hpp"
#include "bench/run/summary.hpp"
#include "bench/scoring/score_statistics.hpp"
#include "bench/scoring/score_table.hpp"
#include "core/files/atomic_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

WalkOutcome ended_by(WalkEnd end, double wall_contact = 0.0) {
  WalkOutcome walk;
  walk.end = end;
  walk.touched_wall = wall_contact > 0.0;
  walk.wall_contact_fraction = wall_contact;
  return walk;
}

/// A record of one estimator, of a robot that came to `robot` after 1.2 s.
RunRecord record(std::uint64_t seed, double ate, const Json& robot) {
  RunRecord run;
  run.seed = seed;
  run.scores = {{"simulated_s", 1.2},
                {"robot", robot},
                {"segments", Json::array()},
                {"estimators", {{"aims", {{"success", true}, {"ate_m", ate}}}}}};
  mark_validity(run.scores);
  return run;
}

const Json kFallen = {{"fell", true}, {"end", "fell"}};
const Json kFine = {{"fell", false}, {"end", "route_done"}};

TEST(Validity, OnlyAFinishedRouteIsValid) {
  EXPECT_FALSE(invalid_reason(ended_by(WalkEnd::kRouteDone), 60.0));
  EXPECT_EQ(invalid_reason(ended_by(WalkEnd::kFell), 1.23), "the robot fell at 1.2 s");
  EXPECT_EQ(invalid_reason(ended_by(WalkEnd::kLeftScene), 7.0),
            "the robot left the scene at 7.0 s");
  for (const WalkEnd end :
       {WalkEnd::kRunning, WalkEnd::kNoProgress, WalkEnd::kTimeLimit, WalkEnd::kUnstablePhysics}) {
    const auto reason = invalid_reason(ended_by(end), 900.0);
    ASSERT_TRUE(reason) << name_of(end);
    EXPECT_NE(reason->find("900.0 s"), std::string::npos) << *reason;
  }
}

TEST(Validity, BrushingAWallIsWalkingAndFollowingItIsNot) {
  EXPECT_FALSE(invalid_reason(ended_by(WalkEnd::kRouteDone, kMaxWallContact), 60.0));
  EXPECT_EQ(invalid_reason(ended_by(WalkEnd::kRouteDone, 0.83), 60.0),
            "the robot touched a wall for 83 % of the time walked");
}

TEST(Validity, IsReadFromRecordsOldAndNew) {
  EXPECT_FALSE(invalid_reason(Json{{"robot", {{"fell", false}, {"touched_wall", true}}}}));
  EXPECT_TRUE(invalid_reason(Json{{"robot", {{"fell", true}}}, {"simulated_s", 3.0}}));
  EXPECT_TRUE(invalid_reason(Json{{"robot", {{"fell", false}, {"end", "no_progress"}}}}));
  EXPECT_TRUE(
      invalid_reason(Json{{"robot", {{"end", "route_done"}, {"wall_contact_fraction", 0.9}}}}));
  EXPECT_FALSE(invalid_reason(Json{{"estimators", Json::object()}})) << "a recording of others";
  EXPECT_TRUE(invalid_reason(Json{{"interrupted", true}}));
  EXPECT_FALSE(invalid_reason(Json{{"robot", nullptr}}));
  EXPECT_FALSE(invalid_reason(Json()));
}

TEST(Validity, MarksTheRecordAndTakesItsSuccesses) {
  const RunRecord fallen = record(3, 0.01, kFallen);
  EXPECT_EQ(fallen.scores["robot"]["valid"], false);
  EXPECT_EQ(fallen.scores["robot"]["invalid_reason"], "the robot fell at 1.2 s");
  EXPECT_EQ(fallen.scores["estimators"]["aims"]["success"], false);
  const RunRecord fine = record(4, 0.01, kFine);
  EXPECT_EQ(fine.scores["robot"]["valid"], true);
  EXPECT_TRUE(fine.scores["robot"]["invalid_reason"].is_null());
  EXPECT_EQ(fine.scores["estimators"]["aims"]["success"], true);
}

TEST(Validity, NoStatisticHoldsAnInvalidRun) {
  const std::vector<RunRecord> runs = {record(1, 0.2, kFine), record(2, 9.0, kFallen),
                                       record(3, 0.4, kFine)};
  const ScoreStatistics ate = statistics_of(runs, "aims", "ate_m");
  EXPECT_EQ(ate.count, 2U);
  EXPECT_NEAR(*ate.median, 0.3, 1e-12);
  EXPECT_NEAR(*ate.worst, 0.4, 1e-12);
  EXPECT_EQ(finished(runs, "aims"), 2U);
  EXPECT_EQ(successes(runs, "aims"), 2U);
  EXPECT_EQ(paired({runs, "aims"}, {runs, "aims"}, "ate_m").value.size(), 2U);
  const std::vector<std::string> row = score_table(runs).rows.at(0);
  EXPECT_EQ(row.at(row.size() - 2), "2/2 (34-100 %)");
  EXPECT_EQ(row.back(), "-") << "of 1 %, which older results lack";
  EXPECT_EQ(left_out_text(runs),
            "1 of 3 runs are invalid and left out: seed 2 (the robot fell at 1.2 s)");
  EXPECT_EQ(invalid_json(runs),
            Json::parse(R"([{"seed": 2, "reason": "the robot fell at 1.2 s"}])"));
}

TEST(ScoreStatistics, TheWorstIsTheSmallestWhereMoreIsBetter) {
  std::vector<RunRecord> runs = {record(1, 0.2, kFine), record(3, 0.4, kFine)};
  runs[0].scores["estimators"]["aims"]["coverage"] = 0.98;
  runs[1].scores["estimators"]["aims"]["coverage"] = 0.94;
  EXPECT_EQ(statistics_of(runs, "aims", "coverage").worst, 0.94);
  EXPECT_EQ(statistics_of(runs, "aims", "ate_m").worst, 0.4);
  EXPECT_EQ(worst_of({8.0, 5.0}, "diverged_at_s"), 5.0) << "the earliest";
  EXPECT_EQ(worst_of({0.8, 0.5}, "weak_axis.all.efficiency"), 0.5);
  EXPECT_EQ(worst_of({0.8, 0.5}, "weak_axis.all.error_rms_m"), 0.8);
  EXPECT_EQ(worst_of({40.0, 55.0}, "health.healthy_s"), 40.0);
}

TEST(Validity, AMedianOverRunsWithoutSuccessIsMarked) {
  std::vector<RunRecord> runs = {record(1, 0.2, kFine), record(3, 0.4, kFine)};
  const auto cells_of = [](const TextTable& table, std::size_t row, const std::string& title) {
    const auto at = std::ranges::find(table.header, title) - table.header.begin();
    return table.rows.at(row).at(static_cast<std::size_t>(at));
  };
  EXPECT_EQ(cells_of(score_table(runs), 0, "ATE start m"), "0.300 (0.400)");
  for (RunRecord& run : runs) {
    run.scores["estimators"]["lio"] = run.scores["estimators"]["aims"];
    run.scores["estimators"]["lio"]["ate_m"] = 0.1;
    run.scores["estimators"]["lio"]["success"] = false;
  }
  const TextTable table = score_table(runs);
  EXPECT_EQ(cells_of(table, 0, "ATE start m"), "0.300 (0.400)*") << "best of those with a success";
  EXPECT_EQ(cells_of(table, 1, "ATE start m"), "0.100 (0.100) x");
  EXPECT_NE(score_legend(runs, {}).find("x: a median over runs of which none succeeded"),
            std::string::npos);
}

TEST(Validity, ASingleInvalidRunHasNoScoresInItsTable) {
  const RunRecord fallen = record(3, 0.01, kFallen);
  const auto row = score_table({&fallen, 1}).rows.at(0);
  EXPECT_EQ(row.back(), "invalid run");
  for (const std::string& cell : row) EXPECT_EQ(cell.find("0.01"), std::string::npos);
}

Scenario expecting(const Expectation& expectation) {
  Scenario scenario;
  scenario.name = "push";
  scenario.expect = {expectation};
  return scenario;
}

std::size_t undemanded(const Expectation& expectation, const std::vector<RunRecord>& runs) {
  return undemanded_runs(runs, check_expectations(expecting(expectation), runs)).size();
}

TEST(Validity, AnExpectationOnTheRunItselfCanDemandAFall) {
  const std::vector<RunRecord> fallen = {record(1, 0.1, kFallen), record(2, 0.1, kFallen)};
  const std::vector<RunRecord> mixed = {record(1, 0.1, kFallen), record(2, 0.1, kFine)};
  const Expectation fall = {"", "robot.fell", kNoLimit, 1.0};
  EXPECT_EQ(undemanded(fall, fallen), 0U);
  EXPECT_EQ(undemanded({"", "robot.valid", 0.0}, fallen), 0U);
  EXPECT_EQ(undemanded(fall, mixed), 1U) << "it does not hold";
  EXPECT_EQ(undemanded({"", "robot.fell", kNoLimit, 0.5, ExpectationStatistic::kMean}, mixed), 0U);
  EXPECT_EQ(undemanded({"", "robot.fell", 1.0}, fallen), 2U) << "it allows, and demands nothing";
  EXPECT_EQ(undemanded({"", "simulated_s", 60.0}, fallen), 2U);
  EXPECT_EQ(undemanded({"aims", "success", kNoLimit, 0.0}, fallen), 2U);
  const std::vector<RunRecord> lost = {record(1, 0.1, {{"fell", false}, {"end", "left_scene"}})};
  EXPECT_EQ(undemanded(fall, lost), 1U);
  EXPECT_EQ(undemanded({"", "robot.valid", 0.0}, lost), 0U);
}

TEST(Validity, ExpectationsOfEstimatorsAreOfValidRuns) {
  const std::vector<RunRecord> runs = {record(1, 0.2, kFine), record(2, 9.0, kFallen)};
  const Expectation limit = {"aims", "ate_m", 0.5};
  Scenario scenario = expecting(limit);
  scenario.run = {"aims"};
  EXPECT_TRUE(check_expectations(scenario, runs).at(0).holds);
  const auto none = check_expectations(scenario, std::span(runs).subspan(1)).at(0);
  EXPECT_FALSE(none.holds);
  EXPECT_FALSE(none.value);
}

TEST(ScoreTable, HasARowForAnEstimatorThatFailed) {
  std::vector<RunRecord> runs = {record(1, 0.1, kFine), record(2, 0.2, kFine),
                                 record(3, 0.3, kFine)};
  for (RunRecord& run : runs) {
    run.scores["failures"] = {{{"estimator", "broken"}, {"message", "no such file"}}};
  }
  runs.front().scores["failures"].push_back({{"estimator", "some"}, {"message", "killed"}});
  for (std::size_t i = 1; i < 3; ++i) {
    runs[i].scores["estimators"]["some"] = runs[i].scores["estimators"]["aims"];
  }
  const auto success_of = [](const TextTable& table, const std::string& name) {
    const auto column = std::ranges::find(table.header, "within 5 %") - table.header.begin();
    const auto row =
        std::ranges::find_if(table.rows, [&](const auto& each) { return each[0] == name; });
    return row == table.rows.end() ? "no row" : (*row)[static_cast<std::size_t>(column)];
  };
  const TextTable table = score_table(runs);
  EXPECT_EQ(success_of(table, "broken"), "failed (3 of 3 seeds)");
  EXPECT_TRUE(success_of(table, "some").starts_with("2/3")) << success_of(table, "some");
  EXPECT_TRUE(success_of(table, "some").ends_with(", 1 failed")) << success_of(table, "some");
  EXPECT_TRUE(success_of(table, "aims").starts_with("3/3"));
  EXPECT_EQ(success_of(score_table({runs.data(), 1}), "broken"), "failed");
}

TEST(ScoreTable, AnEstimatorThatFailedSomewhereHasNoStar) {
  std::vector<RunRecord> runs = {record(1, 0.1, kFine), record(2, 0.9, kFine)};
  runs[0].scores["estimators"]["lucky"] = runs[0].scores["estimators"]["aims"];
  runs[1].scores["failures"] = {{{"estimator", "lucky"}, {"message", "killed"}}};
  const TextTable table = score_table(runs);
  const auto stars = [&](const std::string& name) {
    const auto row =
        std::ranges::find_if(table.rows, [&](const auto& each) { return each[0] == name; });
    return std::ranges::count_if(*row, [](const auto& cell) { return cell.ends_with('*'); });
  };
  EXPECT_EQ(stars("lucky"), 0) << "of the easier seed alone";
  EXPECT_GT(stars("aims"), 0);
}

TEST(ScoreTable, AnEstimatorThatStoppedEarlySomewhereHasNoStar) {
  std::vector<RunRecord> runs = {record(1, 0.9, kFine), record(2, 0.9, kFine)};
  for (RunRecord& run : runs) {
    run.scores["estimators"]["stops"] = run.scores["estimators"]["aims"];
    run.scores["estimators"]["stops"]["ate_m"] = 0.001;
  }
  const auto stars = [&] {
    const TextTable table = score_table(runs);
    const auto row =
        std::ranges::find_if(table.rows, [](const auto& each) { return each[0] == "stops"; });
    return std::ranges::count_if(*row, [](const auto& cell) { return cell.ends_with('*'); });
  };
  EXPECT_GT(stars(), 0);
  runs[1].scores["estimators"]["stops"]["success"] = false;
  runs[1].scores["estimators"]["stops"]["diverged_reason"] = "error_limit";
  EXPECT_GT(stars(), 0) << "its error is that of the whole run";
  runs[1].scores["estimators"]["stops"]["diverged_reason"] = "ends_early";
  EXPECT_EQ(stars(), 0);
}

TEST(ScoreTable, OfARunOnWhichEveryEstimatorFailedHasTheirRows) {
  RunRecord run;
  run.seed = 1;
  run.scores["failures"] = {{{"estimator", "broken"}, {"message", "boom"}}};
  const TextTable table = score_table({&run, 1});
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.rows[0][0], "broken");
  EXPECT_FALSE(score_legend({&run, 1}, {}).empty());
}

TEST(ScoreStatistics, OfErrorsWithASignTheWorstIsTheLargest) {
  EXPECT_EQ(worst_of({-3.0, 1.0, 2.0}, "drift_m.end.longitudinal"), -3.0);
  EXPECT_EQ(worst_of({0.1, 0.3}, "ate_yaw_m"), 0.3);
  EXPECT_EQ(worst_of({0.0, 1.0}, "success"), 0.0);
}

/// Whether the legend explains stars, lost medians and parts.
std::vector<bool> explained(const std::vector<RunRecord>& runs) {
  const std::string legend = score_legend(runs, {});
  const auto has = [&](const char* text) { return legend.find(text) != std::string::npos; };
  return {has("A star: "), has("x: a median"), has("part: over the parts")};
}

TEST(ScoreTable, ExplainsOnlyTheMarksThatStandInIt) {
  std::vector<RunRecord> runs = {record(1, 0.2, kFine), record(2, 0.2, kFine)};
  EXPECT_EQ(explained(runs), (std::vector{false, false, false})) << "one estimator is no best";
  for (RunRecord& run : runs) {
    run.scores["failures"] = {{{"estimator", "broken"}, {"message", "no such file"}}};
  }
  EXPECT_EQ(explained(runs), (std::vector{true, false, false})) << "a row without figures";
  for (RunRecord& run : runs) {
    run.scores["estimators"]["stops"] = {
        {"ate_m", 0.1}, {"success", false}, {"diverged_reason", "ends_early"}};
  }
  EXPECT_EQ(explained(runs), (std::vector{true, true, true}));
  for (RunRecord& run : runs) run.scores["estimators"].erase("aims");
  EXPECT_EQ(explained(runs), (std::vector{false, true, true})) << "no success is best";
  const std::vector<RunRecord> fine = {record(1, 0.2, kFine)};
  const std::string both = legend_of_tables({fine, runs}, {});
  EXPECT_NE(both.find("part: over the parts"), std::string::npos) << "of the second table";
}

TEST(Validity, AnExampleIsTheFirstValidRunWithAnEstimate) {
  std::vector<RunRecord> runs = {record(1, 0.2, kFallen), record(2, 0.2, kFine),
                                 record(3, 0.2, kFine)};
  EXPECT_EQ(example_run(runs)->seed, 2U);
  runs[2].scores["estimators"]["late"] = {{"ate_m", 0.3}};
  EXPECT_EQ(example_run(runs, "late")->seed, 3U);
  EXPECT_EQ(score_keys_in(runs, "late"), std::vector<std::string>{"ate_m"});
  EXPECT_EQ(example_run({runs.data(), 1}), nullptr);
  EXPECT_TRUE(score_keys_in(runs, "nobody").empty());
}

TEST(Summary, HasAnEstimatorThatFailedOnTheFirstSeed) {
  std::vector<RunRecord> runs = {record(1, 0.2, kFine), record(2, 0.2, kFine)};
  runs[0].scores["failures"] = {{{"estimator", "late"}, {"message", "killed"}}};
  runs[1].scores["estimators"]["late"] = {{"ate_m", 0.3}, {"success", true}};
  const TemporaryFolder folder;
  ASSERT_TRUE(write_summary({Scenario(), runs, {}}, folder.path()));
  const Json json = Json::parse(*read_file(folder.path() / "summary.json"));
  EXPECT_EQ(json["estimators"]["late"]["ate_m"]["median"], 0.3);
  EXPECT_EQ(json["estimators"]["aims"]["ate_m"]["count"], 2);
}

TEST(ScoreRecord, NamesTheEstimatorsThatLackAPart) {
  RunRecord run = record(1, 0.2, kFine);
  run.scores["estimators"]["stops"] = {{"success", false}, {"diverged_reason", "ends_early"}};
  run.scores["estimators"]["strays"] = {{"success", false}, {"diverged_reason", "error_limit"}};
  run.scores["failures"] = {{{"estimator", "broken"}, {"message", "killed"}}};
  EXPECT_EQ(partial_in(run), (std::vector<std::string>{"stops", "broken"}));
  run.scores["robot"] = kFallen;
  EXPECT_TRUE(partial_in(run).empty()) << "an invalid run says nothing";
}

}  // namespace
}  // namespace aims
