// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>

#include "bench/jobs/stored_results.hpp"
#include "bench/studies/families.hpp"
#include "bench/studies/success_pairs.hpp"
#include "bench/studies/suite.hpp"
#include "bench/studies/suite_summary.hpp"
#include "core/files/atomic_file.hpp"
#include "tests/bench/studies/short_walk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using test::keep_going;
using test::options_for;

Scenario short_walk(const std::string& name, double range) {
  Scenario scenario = test::short_walk(name);
  scenario.family = "range";
  scenario.level = range;
  scenario.level_unit = "m";
  scenario.simulation.lidar.range_max = range;
  return scenario;
}

std::vector<ScenarioFile> two_walks() {
  return {{"near.yaml", short_walk("near", 3.0)}, {"far.yaml", short_walk("far", 20.0)}};
}

/// Does the jobs and writes the views.
Suite run_or_die(std::vector<ScenarioFile> scenarios, const SuiteOptions& options) {
  auto suite = run_suite(std::move(scenarios), options, keep_going);
  EXPECT_TRUE(suite) << suite.error().message;
  if (!suite) return {};
  EXPECT_TRUE(write_suite(*suite, options.jobs.out));
  return std::move(*suite);
}

/// The views of a suite, by file, but for the times.
std::map<std::string, std::string> views(const fs::path& folder) {
  std::map<std::string, std::string> texts;
  for (const char* name : {"suite.json", "suite.csv", "suite.md", "suite.tex"}) {
    const auto text = read_file(folder / name);
    EXPECT_TRUE(text) << name;
    texts[name] = text.value_or("");
  }
  return texts;
}

/// Expects equal texts without printing them.
void expect_same(const std::map<std::string, std::string>& a,
                 const std::map<std::string, std::string>& b) {
  for (const auto& [name, text] : a) {
    if (text == b.at(name)) continue;
    const auto at = std::mismatch(text.begin(), text.end(), b.at(name).begin(), b.at(name).end());
    const auto begin = static_cast<std::size_t>(at.first - text.begin());
    ADD_FAILURE() << name << " differs at byte " << begin << ":\n"
                  << text.substr(begin, 80) << "\n"
                  << b.at(name).substr(begin, 80);
  }
}

/// One finished suite that the tests copy, so that little is simulated.
class SuiteRuns : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new TemporaryFolder;
    run_or_die(two_walks(), options_for(shared_->path() / "done"));
  }
  static void TearDownTestSuite() { delete shared_; }

  fs::path copy() const {
    fs::copy(shared_->path() / "done", folder_.path() / "copy", fs::copy_options::recursive);
    return folder_.path() / "copy";
  }

  static TemporaryFolder* shared_;
  TemporaryFolder folder_;
};

TemporaryFolder* SuiteRuns::shared_ = nullptr;

TEST_F(SuiteRuns, GiveTheSameBytesForAnyNumberOfJobs) {
  const Suite suite = run_or_die(two_walks(), options_for(folder_.path() / "two", 2));
  EXPECT_EQ(suite.run.done, 8U);
  expect_same(views(shared_->path() / "done"), views(folder_.path() / "two"));
}

TEST_F(SuiteRuns, AreNeverRepeated) {
  const fs::path out = copy();
  const auto before = views(out);
  const Suite again = run_or_die(two_walks(), options_for(out));
  EXPECT_EQ(again.run.done, 0U);
  EXPECT_EQ(again.run.reused, 8U);
  expect_same(before, views(out));
}

TEST_F(SuiteRuns, ResumeToTheSameViewsAfterALossOrABrokenFile) {
  const fs::path out = copy();
  const auto before = views(out);
  const auto jobs = JobStore(out).listed();
  ASSERT_TRUE(jobs);
  fs::remove(out / "jobs" / (jobs->front().id + ".json"));
  std::ofstream(out / "jobs" / (jobs->back().id + ".json")) << R"({"schema": "aims.jo)";
  EXPECT_EQ(run_or_die(two_walks(), options_for(out, 2)).run.done, 2U);
  expect_same(before, views(out));
}

TEST_F(SuiteRuns, ContinueWhereTheyWereStopped) {
  const fs::path out = folder_.path() / "stopped";
  const auto stopped = run_suite(two_walks(), options_for(out),
                                 [](const JobProgress& progress) { return progress.done < 2; });
  ASSERT_TRUE(stopped);
  EXPECT_FALSE(stopped->complete);
  EXPECT_EQ(stopped->run.done, 2U);
  EXPECT_EQ(suite_json(*stopped)["complete"], false);
  EXPECT_EQ(run_or_die(two_walks(), options_for(out)).run.done, 6U);
  expect_same(views(out), views(shared_->path() / "done"));
}

TEST_F(SuiteRuns, DoOnlyTheJobsThatAreMissingOrOfAnotherConfiguration) {
  const fs::path out = copy();
  std::vector<ScenarioFile> scenarios = two_walks();
  scenarios[0].scenario->run = {"aims+degeneracy.eta=1", "leg", "lio"};
  const Suite again = run_or_die(std::move(scenarios), options_for(out));
  EXPECT_EQ(again.run.done, 4U) << "two estimators on two seeds";
  EXPECT_EQ(again.run.sequences, 0U);
  EXPECT_EQ(run_or_die(two_walks(), options_for(out)).run.done, 0U) << "nothing was lost";
}

TEST_F(SuiteRuns, GoOnPastAScenarioThatCannotRun) {
  const fs::path out = copy();
  std::vector<ScenarioFile> scenarios = two_walks();
  Scenario in_wall = short_walk("in_wall", 5.0);
  in_wall.simulation.route.points = {{"a", 0.0, 1.1}, {"b", 3.0, 1.1}};
  scenarios.push_back({"in_wall.yaml", in_wall});
  scenarios.push_back({"broken.yaml", failure("broken.yaml:1: no")});
  const Suite suite = run_or_die(std::move(scenarios), options_for(out));
  EXPECT_TRUE(suite.complete);
  EXPECT_EQ(suite.run.reused, 8U);
  ASSERT_EQ(suite.failures.size(), 3U);  // the broken file, and two seeds in the wall
  EXPECT_EQ(suite.failures[0].scenario, "broken");
  EXPECT_EQ(suite.failures[1].seed, 1U);
  EXPECT_EQ(Json::parse(std::ifstream(out / "suite.json"))["failures"].size(), 3U);
}

TEST_F(SuiteRuns, StateWhatIsSetOnTopAndRefuseAFolderOfOtherSettings) {
  const fs::path out = copy();
  const auto with = [](const char* setting) {
    std::vector<ScenarioFile> scenarios = two_walks();
    for (ScenarioFile& each : scenarios) each.scenario->overrides = {setting, "run=[leg, aims]"};
    return scenarios;
  };
  const auto refused = run_suite(with("lidar.range_max=9"), options_for(out), keep_going);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("holds results with no --set, and this command has --set "
                                         "lidar.range_max=9; give another --out, or --overwrite"),
            std::string::npos)
      << refused.error().message;
  SuiteOptions replace = options_for(out);
  replace.jobs.redo = true;
  run_or_die(with("lidar.range_max=9"), replace);
  EXPECT_EQ(Json::parse(std::ifstream(out / "suite.json"))["settings"],
            Json::parse(R"(["lidar.range_max=9"])"));
  EXPECT_NE(read_file(out / "suite.md")->find("Set on top of the scenario: `lidar.range_max=9`."),
            std::string::npos);
  EXPECT_FALSE(run_suite(with("lidar.range_max=8"), options_for(out), keep_going));
  EXPECT_TRUE(run_suite(with("lidar.range_max=9"), options_for(out), keep_going));
}

TEST_F(SuiteRuns, AreCompleteWithAnEstimatorThatFailed) {
  JobResult done;
  done.scores = done.sequence = Json::object();
  JobResult failed;
  failed.outcome = JobOutcome::kFailed;
  failed.message = "add_legs: no";
  const std::vector<LabelledResult> results = {{"leg", done}, {"mine", failed}};
  const Json scores = record_of("walk", 1, results).scores;
  EXPECT_EQ(scores["complete"], true) << "the run reached its end";
  EXPECT_EQ(scores["failures"],
            Json::parse(R"([{"estimator": "mine", "message": "add_legs: no"}])"));
  EXPECT_EQ(record_of("walk", 1, results, false).scores["complete"], false);
}

TEST_F(SuiteRuns, CheckTheExpectationsOverTheirSeeds) {
  std::vector<ScenarioFile> scenarios = two_walks();
  scenarios[0].scenario->expect = {{"aims", "success", kNoLimit, 1.0, ExpectationStatistic::kMean},
                                   {"leg", "ate_m", kNoLimit, 50.0, ExpectationStatistic::kMedian}};
  const Suite suite = run_or_die(std::move(scenarios), options_for(copy()));
  EXPECT_EQ(suite.run.done, 0U) << "an expectation decides no run";
  ASSERT_EQ(suite.cases[0].expectations.size(), 2U);
  EXPECT_TRUE(suite.cases[0].expectations[0].holds);
  EXPECT_FALSE(suite.cases[0].expectations[1].holds);
}

/// A case of a family with one run per ATE.
SuiteCase family_case(double level, const std::vector<double>& ates, bool success) {
  SuiteCase each;
  each.scenario.name = "case";
  each.scenario.family = "f";
  each.scenario.level = level;
  each.scenario.run = {"aims"};
  each.scenario.simulation.route.points = {{"a", 0.0, 0.0}, {"b", 10.0, 0.0}, {"a", 0.0, 0.0}};
  for (const double ate : ates) {
    RunRecord run;
    run.seed = each.runs.size() + 1;
    run.scores["estimators"]["aims"] = {{"ate_yaw_m", ate}, {"success", success}};
    each.runs.push_back(std::move(run));
  }
  return each;
}

TEST(Families, BreakWhereTheErrorDoublesOrRunsDivergeOnEitherSideOfTheMildest) {
  Suite suite;
  suite.cases = {family_case(20.0, {0.1, 0.12}, false), family_case(-10.0, {0.3, 0.25}, true),
                 family_case(0.0, {0.1, 0.1}, true), family_case(10.0, {0.19, 0.19}, true)};
  const auto families = family_results(suite);
  ASSERT_EQ(families.size(), 1U);
  EXPECT_EQ(families[0].mildest, 0.0);
  ASSERT_EQ(families[0].curves.size(), 1U);
  EXPECT_EQ(families[0].curves[0].points.front().level, -10.0);
  EXPECT_EQ(families[0].curves[0].breaks_at, std::vector<double>({-10.0, 20.0}));
}

TEST(Families, NameLevelsThatTheSeedsDoNotTellApartFromTheMildest) {
  const std::vector<double> base = {0.10, 0.11, 0.12, 0.13, 0.14, 0.15, 0.16, 0.17};
  std::vector<double> alike = base;  // as often a little better as worse
  for (std::size_t i = 0; i < alike.size(); ++i) alike[i] += i % 2 ? 0.01 : -0.0099;
  std::vector<double> worse = base;
  for (double& ate : worse) ate *= 1.3;
  Suite suite;
  suite.cases = {family_case(1.0, base, true), family_case(2.0, alike, true),
                 family_case(3.0, worse, true), family_case(4.0, base, false)};
  const FamilyResult family = family_results(suite).at(0);
  EXPECT_EQ(family.mildest == 1.0 ? family.alike : std::vector{1.0},
            std::optional(std::vector{family.mildest == 1.0 ? 2.0 : 1.0}))
      << "3 has larger errors on each seed, 4 no success";
  EXPECT_EQ(breaks_table({family}).rows.at(0).at(3), family.mildest == 1.0 ? "2" : "1");
  suite.cases.erase(suite.cases.begin() + 1);
  EXPECT_EQ(alike_text(family_results(suite).at(0)), "-");
  for (SuiteCase& each : suite.cases) each.runs.resize(5);
  const FamilyResult few = family_results(suite).at(0);
  EXPECT_FALSE(few.alike);
  EXPECT_EQ(alike_text(few), "fewer than 6 seeds");
  EXPECT_TRUE(families_json({few})[0]["alike_levels"].is_null());
}

TEST(SuiteTables, MarkEstimatesThatLackAPartAndSayWhatThatMeans) {
  Suite suite;
  suite.cases = {family_case(0.0, {0.1, 0.2}, true), family_case(1.0, {0.1, 0.2}, true)};
  EXPECT_EQ(suite_markdown(suite, {}).find("part"), std::string::npos);
  Json& stops = suite.cases[1].runs[0].scores["estimators"]["aims"];
  stops["success"] = false;
  stops["diverged_reason"] = "ends_early";
  const std::string text = suite_markdown(suite, {});
  EXPECT_NE(text.find(" part |"), std::string::npos) << text;
  EXPECT_NE(text.find("part: over the parts of the runs that have poses alone."),
            std::string::npos);
  const auto points = family_results(suite).at(0).curves.at(0).points;
  EXPECT_FALSE(points[0].partial);
  EXPECT_TRUE(points[1].partial);
}

TEST(Families, BreakWhereEveryRunFails) {
  Suite suite;
  suite.cases = {family_case(0.0, {0.1, 0.1}, true), family_case(1.0, {0.1, 0.1}, true)};
  for (RunRecord& run : suite.cases[1].runs) {
    run.scores["estimators"] = Json::object();
    run.scores["failures"] = {{{"estimator", "aims"}, {"message", "killed"}}};
  }
  const FamilyCurve curve = family_results(suite)[0].curves[0];
  EXPECT_EQ(curve.breaks_at, std::vector<double>{1.0});
  EXPECT_EQ(curve.points[1].runs, 2U);
  EXPECT_EQ(curve.points[1].success_rate, 0.0);
}

TEST(Families, DoNotBreakAtTwiceAFewCentimetres) {
  Suite suite;
  suite.cases = {family_case(0.0, {0.025}, true), family_case(1.0, {0.052}, true),
                 family_case(2.0, {0.101}, true)};
  EXPECT_EQ(family_results(suite)[0].curves[0].breaks_at, std::vector<double>{2.0})
      << "0.5 % of 20 m are 0.1 m";
  for (SuiteCase& each : suite.cases) each.scenario.simulation.route.points[1].x = 5.0;
  EXPECT_EQ(family_results(suite)[0].curves[0].breaks_at, std::vector<double>{1.0});
}

TEST(Families, StateTheIntervalOfTheSuccessRate) {
  Suite suite;
  suite.cases = {family_case(0.0, std::vector<double>(20, 0.1), false),
                 family_case(1.0, {0.1}, true)};
  const FamilyPoint& none = family_results(suite)[0].curves[0].points[0];
  EXPECT_NEAR(none.success_interval.low.value(), 0.0, 1e-12);
  EXPECT_NEAR(none.success_interval.high.value(), 0.1611, 5e-5) << "Newcombe 1998: 0 of 20";
}

/// A suite of two scenarios; a run of that seed of `aims` and `lio` is a success where these say
/// so.
Suite suite_of_pairs(int seeds, const std::function<bool(bool first_scenario, int seed)>& aims,
                     const std::function<bool(bool first_scenario, int seed)>& lio) {
  Suite suite;
  for (const bool first : {true, false}) {
    SuiteCase each;
    each.scenario.name = first ? "first" : "second";
    each.scenario.run = {"aims", "lio"};
    for (int seed = 1; seed <= seeds; ++seed) {
      RunRecord run;
      run.seed = static_cast<std::uint64_t>(seed);
      run.scores["estimators"]["aims"] = {{"success", aims(first, seed)}};
      run.scores["estimators"]["lio"] = {{"success", lio(first, seed)}};
      each.runs.push_back(std::move(run));
    }
    suite.cases.push_back(std::move(each));
  }
  return suite;
}

// Two scenarios of one seed have the same sensors: that is no more evidence than one.
TEST(SuccessPairs, CountSeedsNotTheirScenarios) {
  const auto always = [](bool, int) { return true; };
  const auto never = [](bool, int) { return false; };
  const auto pairs = success_pairs(suite_of_pairs(3, always, never));
  ASSERT_EQ(pairs.size(), 1U);
  const SuccessTest& test = pairs[0].tests[0];
  EXPECT_EQ(test.sequences, 6U);
  EXPECT_EQ(test.seeds, 3U);
  EXPECT_EQ(test.only_first, 6U);
  EXPECT_EQ(test.by_seed.only_first, 3U);
  EXPECT_NEAR(test.by_seed.p, 2.0 / 8.0, 1e-12) << "of sequences it were 2 / 64";
}

TEST(SuccessPairs, OfASeedCountTheOneWithMoreSuccesses) {
  // Seed 1: one each, which decides nothing; seed 2: aims alone once, both once; seed 3: lio twice.
  const auto aims = [](bool first, int seed) { return seed == 1 ? first : seed == 2; };
  const auto lio = [](bool first, int seed) {
    return seed == 1 ? !first : seed == 2 ? first : true;
  };
  const Suite suite = suite_of_pairs(3, aims, lio);
  const SuccessTest test = success_pairs(suite).at(0).tests[0];
  EXPECT_EQ(test.only_first, 2U);
  EXPECT_EQ(test.only_second, 3U);
  EXPECT_EQ(test.by_seed.only_first, 1U);
  EXPECT_EQ(test.by_seed.only_second, 1U);
  EXPECT_EQ(success_pairs_table(suite, false).rows.at(0).at(5), "1, 1");
}

TEST(SuccessPairs, OfOneScenarioAreMcNemarsTest) {
  Suite suite = suite_of_pairs(
      8, [](bool, int seed) { return seed != 1; }, [](bool, int seed) { return seed == 1; });
  suite.cases.pop_back();
  const SuccessTest test = success_pairs(suite).at(0).tests[0];
  EXPECT_EQ(test.by_seed.only_first, 7U);
  EXPECT_EQ(test.by_seed.only_second, 1U);
  EXPECT_NEAR(test.by_seed.p, 0.0703, 5e-5) << "Fagerland et al. 2013";
  EXPECT_EQ(success_pairs_table(suite, false).rows.at(0).at(6), "0.0703");
  EXPECT_EQ(success_rate(suite.cases[0].runs, "aims").text(), "7/8 (53-98 %)");
}

TEST(Families, OfOneLevelAreNone) {
  Suite suite;
  suite.cases = {family_case(1.0, {0.1}, true)};
  EXPECT_TRUE(family_results(suite).empty());
}

}  // namespace
}  // namespace aims
