// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/sweep_summary.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "bench/tuning/point_table.hpp"
#include "estimator/degeneracy/degeneracy.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

constexpr const char* kEta = "degeneracy.eta";

MergedJob unit_of(const std::string& scenario, int seed, const Json& settings, double ate) {
  MergedJob unit;
  unit.listed = {"id", scenario, fmt::format("{}", seed), "aims", ""};
  unit.file = {{"schema", kJobSchema}, {"scenario", scenario},
               {"family", ""},         {"seed", seed},
               {"estimator", "aims"},  {"settings", settings},
               {"outcome", "done"},    {"scores", {{"ate_yaw_m", ate}, {"success", true}}}};
  return unit;
}

/// eta from 0 to 6 in 13 steps, best at 1; with the untuned estimator (eta 3) where asked for.
MergedSweep sweep_over_eta(bool untuned) {
  MergedSweep sweep;
  sweep.plans = {"# aims sweep\nparams: [\"degeneracy.eta=0:6:13\"]\nscenarios: [corridor]\n"};
  const auto ate = [](double eta, int seed) { return 0.1 * seed * (1.0 + std::abs(eta - 1.0)); };
  for (int seed = 1; seed <= 4; ++seed) {
    if (untuned) sweep.jobs.push_back(unit_of("corridor", seed, Json::object(), ate(3.0, seed)));
    for (int k = 0; k <= 12; ++k) {
      const double eta = 0.5 * k;
      sweep.jobs.push_back(
          unit_of("corridor", seed, {{kEta, fmt::format("{}", eta)}}, ate(eta, seed)));
    }
  }
  return sweep;
}

std::string report_of(const MergedSweep& sweep, const std::filesystem::path& folder) {
  const auto written = write_sweep_summary(sweep, {}, folder);
  EXPECT_TRUE(written) << written.error().message;
  std::ifstream stream(folder / "sweep.md");
  return {std::istreambuf_iterator<char>(stream), {}};
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(SweepReport, TableHasEveryPointAndTheUntunedRuns) {
  const auto responses = sweep_responses(sweep_over_eta(true), "ate_yaw_m");
  ASSERT_TRUE(responses) << responses.error().message;
  ASSERT_EQ(responses->size(), 1U);
  const ResponseTable& table = responses->front().table;
  EXPECT_EQ(responses->front().estimator, "aims");
  EXPECT_EQ(table.points.size(), 13U);
  EXPECT_EQ(table.cases.size(), 4U);
  EXPECT_EQ(table.default_runs.size(), 4U);
  EXPECT_EQ(table.defaults, (std::vector<double>{DegeneracyConfig{}.eta}));
  for (std::size_t k = 0; k < table.points.size(); ++k) {
    EXPECT_NEAR(*table.runs[k][2].value, 0.3 * (1.0 + std::abs(table.points[k][0] - 1.0)), 1e-12);
  }
}

TEST(SweepReport, SaysTheBest) {
  const TemporaryFolder folder;
  const std::string text = report_of(sweep_over_eta(true), folder.path());
  EXPECT_TRUE(says(text, "| degeneracy.eta |")) << text;
  EXPECT_TRUE(says(text, "1 [1, 1]")) << text;
  EXPECT_TRUE(says(text, "Reduction by 67 % [67, 67]")) << text;
}

TEST(SweepReport, WithoutUntunedRunsComparesPlainScores) {
  const TemporaryFolder folder;
  MergedSweep sweep = sweep_over_eta(false);
  std::erase_if(sweep.jobs, [](const MergedJob& job) { return job.file["settings"][kEta] == "3"; });
  const std::string text = report_of(sweep, folder.path());
  EXPECT_TRUE(says(text, "median of ate_yaw_m; a diverged run counts")) << text;
  EXPECT_TRUE(says(text, "these were not run on every sequence")) << text;
}

TEST(SweepReport, LeavesOutPointsThatAreNotDoneOnAllWalks) {
  MergedSweep sweep = sweep_over_eta(true);
  sweep.jobs[3].file = Json();
  sweep.jobs.back().file = Json();
  const auto responses = sweep_responses(sweep, "ate_yaw_m");
  ASSERT_TRUE(responses);
  EXPECT_EQ(responses->front().incomplete, 2U);
  EXPECT_EQ(responses->front().table.points.size(), 11U);
}

TEST(SweepReport, OneUnitIsBothTheUntunedOneAndAPointOfTheGrid) {
  MergedSweep sweep = sweep_over_eta(true);
  const std::string own = fmt::format("{}", DegeneracyConfig{}.eta);
  std::erase_if(sweep.jobs, [&](const MergedJob& unit) {
    return unit.file["settings"].value(kEta, "") == own;
  });
  const auto responses = sweep_responses(sweep, "ate_yaw_m");
  ASSERT_TRUE(responses);
  const ResponseTable& table = responses->front().table;
  ASSERT_EQ(table.points.size(), 13U);
  EXPECT_EQ(table.points.back(), table.defaults);
  EXPECT_EQ(table.runs.back()[1].value, table.default_runs[1].value);
}

TEST(SweepReport, ListsTheDefaultsOnceWhereTheyAreAPointOfTheGrid) {
  const auto responses = sweep_responses(sweep_over_eta(true), "ate_yaw_m");
  ASSERT_TRUE(responses);
  const TextTable table = point_table(*responses, Objective());
  EXPECT_EQ(table.rows.size(), 13U);
  EXPECT_EQ(table.rows[0][0], "aims (default)");
}

TEST(SweepReport, AShortTableKeepsTheDefaultsAndTheLeastObjectives) {
  const auto responses = sweep_responses(sweep_over_eta(true), "ate_yaw_m");
  ASSERT_TRUE(responses);
  const TextTable all = point_table(*responses, Objective());
  const TextTable shown = point_table(*responses, Objective(), 3);
  const auto best = std::ranges::find_if(all.rows, [](const auto& row) {
    return std::ranges::any_of(row, [](const std::string& cell) { return says(cell, " best"); });
  });
  ASSERT_NE(best, all.rows.end());
  ASSERT_GE(best - all.rows.begin(), 3) << "the first rows do not have it";
  ASSERT_EQ(shown.rows.size(), 3U);
  EXPECT_EQ(shown.rows[0], all.rows[0]) << "the defaults";
  EXPECT_NE(std::ranges::find(shown.rows, *best), shown.rows.end());
}

TEST(SweepReport, NamesSequencesOfWhichNoJobIsDone) {
  MergedSweep sweep = sweep_over_eta(true);
  EXPECT_EQ(unstarted_text(sweep), "");
  for (MergedJob& job : sweep.jobs) {
    if (job.listed.seed == "4") job.file = Json();
  }
  EXPECT_EQ(unstarted_text(sweep),
            "1 of 4 sequences are left out, since no job of them is done: corridor seed 4");
}

// A tuning has the defaults among its points and runs them as such.
TEST(SweepReport, ADefaultOfZeroHasNoDistanceOnALogarithmicRange) {
  MergedSweep sweep = sweep_over_eta(true);
  sweep.plans = {
      "params: [\"degeneracy.eta=log(0.5,6,12)\"]\nscenarios: [corridor]\n"
      "set: [estimators.aims.degeneracy.eta=0]\n"};
  const TemporaryFolder folder;
  const std::string text = report_of(sweep, folder.path());
  EXPECT_FALSE(says(text, "inf")) << text;
  EXPECT_FALSE(says(text, "nan")) << text;
}

TEST(SweepReport, FindsTheDefaultsAmongThePoints) {
  const auto responses = sweep_responses(sweep_over_eta(false), "ate_yaw_m");
  ASSERT_TRUE(responses);
  const ResponseTable& table = responses->front().table;
  ASSERT_EQ(table.default_runs.size(), 4U);
  EXPECT_EQ(table.default_runs[0].value, 0.1 * (1.0 + 2.0));
}

TEST(SweepReport, KeepsTheLabelOfAnEstimator) {
  MergedSweep sweep = sweep_over_eta(true);
  sweep.plans = {
      "params: [\"degeneracy.eta=0:6:13\"]\nscenarios: [corridor]\n"
      "estimators: [slow=aims+degeneracy.alpha=0.5]\n"};
  for (MergedJob& job : sweep.jobs) job.file["settings"]["degeneracy.alpha"] = "0.5";
  const auto responses = sweep_responses(sweep, "ate_yaw_m");
  ASSERT_TRUE(responses) << responses.error().message;
  ASSERT_EQ(responses->size(), 1U);
  EXPECT_EQ(responses->front().estimator, "slow=aims+degeneracy.alpha=0.5");
}

TEST(SweepReport, KeepsTheLabelOfAnEstimatorThatSetsTheVariedKey) {
  MergedSweep sweep = sweep_over_eta(true);
  sweep.plans = {
      "params: [\"degeneracy.eta=0:6:13\"]\nscenarios: [corridor]\n"
      "estimators: [high=aims+degeneracy.eta=5.2]\n"};
  for (MergedJob& job : sweep.jobs) {
    if (job.file["settings"].empty()) job.file["settings"][kEta] = "5.2";
  }
  const auto responses = sweep_responses(sweep, "ate_yaw_m");
  ASSERT_TRUE(responses) << responses.error().message;
  ASSERT_EQ(responses->size(), 1U);
  EXPECT_EQ(responses->front().estimator, "high=aims+degeneracy.eta=5.2");
  EXPECT_EQ(responses->front().table.points.size(), 13U);
  EXPECT_EQ(responses->front().table.default_runs.size(), 4U);
  EXPECT_EQ(responses->front().table.defaults, std::vector<double>{5.2});
}

TEST(SweepReport, CallsNoPointBestByWhatIsNotResolved) {
  MergedSweep sweep = sweep_over_eta(true);
  std::erase_if(sweep.jobs, [](const MergedJob& job) { return job.listed.seed != "1"; });
  for (MergedJob& job : sweep.jobs) {
    double& ate = job.file["scores"]["ate_yaw_m"].get_ref<double&>();
    ate = 1.0 + 0.001 * ate;
  }
  const auto responses = sweep_responses(sweep, "ate_yaw_m");
  ASSERT_TRUE(responses);
  const std::string text = to_text(point_table(*responses, Objective()));
  EXPECT_TRUE(says(text, " least, not resolved")) << text;
  EXPECT_FALSE(says(text, " best")) << text;
  EXPECT_TRUE(
      says(to_text(point_table(*sweep_responses(sweep_over_eta(true), "ate_yaw_m"), Objective())),
           " best"));
}

TEST(SweepReport, CallsNoPointBestOfOneSeed) {
  MergedSweep sweep = sweep_over_eta(true);
  std::erase_if(sweep.jobs, [](const MergedJob& job) { return job.listed.seed != "1"; });
  const std::string text = to_text(point_table(*sweep_responses(sweep, "ate_yaw_m"), Objective()));
  EXPECT_TRUE(says(text, "least, not resolved")) << text;
}

TEST(SweepReport, KnowsWhatScenariosHaveOfVariedKeysOfTheirOwn) {
  MergedSweep sweep;
  sweep.plans = {"params: [\"links.leg_odometry.loss=0:0.5:6\"]\nscenarios: [corridor]\n"};
  for (int seed = 1; seed <= 2; ++seed) {
    sweep.jobs.push_back(unit_of("corridor", seed, Json::object(), 0.1));
    for (int k = 0; k <= 5; ++k) {
      const Json settings = {{"links.leg_odometry.loss", fmt::format("{}", 0.1 * k)}};
      sweep.jobs.push_back(unit_of("corridor", seed, settings, 0.1 + 0.02 * k * seed));
      sweep.jobs.back().file["defaults"] = {{"links.leg_odometry.loss", "0.05"}};
    }
  }
  const auto responses = sweep_responses(sweep, "ate_yaw_m");
  ASSERT_TRUE(responses) << responses.error().message;
  const ResponseTable& table = responses->front().table;
  EXPECT_EQ(table.defaults, std::vector<double>{0.05});
  EXPECT_EQ(table.points.size(), 6U);
  const TemporaryFolder folder;
  EXPECT_TRUE(says(report_of(sweep, folder.path()), "| links.leg_odometry.loss |"));
}

TEST(SweepReport, FailedUnitsCountAsLost) {
  MergedSweep sweep = sweep_over_eta(true);
  sweep.jobs[1].file["outcome"] = "crashed";
  const auto responses = sweep_responses(sweep, "ate_yaw_m");
  ASSERT_TRUE(responses);
  EXPECT_TRUE(responses->front().table.runs[0][0].diverged);
  EXPECT_EQ(responses->front().incomplete, 0U);
}

TEST(SweepReport, KeepsEstimatorsWithOtherSettingsApart) {
  MergedSweep sweep = sweep_over_eta(false);
  const MergedSweep again = sweep;
  for (MergedJob job : again.jobs) {
    job.file["settings"]["degeneracy.alpha"] = "0.5";
    sweep.jobs.push_back(job);
  }
  const auto responses = sweep_responses(sweep, "ate_yaw_m");
  ASSERT_TRUE(responses);
  ASSERT_EQ(responses->size(), 2U);
  EXPECT_EQ((*responses)[1].estimator, "aims+degeneracy.alpha=0.5");
  EXPECT_EQ((*responses)[1].table.points.size(), 13U);
}

TEST(SweepReport, RefusesAPlanThatVariesNothing) {
  MergedSweep sweep = sweep_over_eta(true);
  sweep.plans = {"scenarios: [corridor]\n"};
  const auto responses = sweep_responses(sweep, "ate_yaw_m");
  ASSERT_FALSE(responses);
  EXPECT_TRUE(says(responses.error().message, "varies nothing"));
}

}  // namespace
}  // namespace aims
