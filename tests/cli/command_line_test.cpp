// SPDX-License-Identifier: BSD-3-Clause
// Runs the real `aims` command as a user would.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::Outcome;

class CommandLine : public testing::CommandLine {
 protected:
  /// The run is refused: exit 2, one line that holds `expected`, and nothing written.
  void expect_refused(const std::string& arguments, const std::string& expected) const {
    const Outcome outcome = aims("run " + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
    EXPECT_NE(outcome.output.find(expected), std::string::npos) << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    EXPECT_FALSE(fs::exists(folder_.path() / "out"));
  }

  const std::string kCorridor = std::string("'") + AIMS_SCENARIOS "/paper/corridor.yaml'";
};

TEST_F(CommandLine, RunsAShortWalkAndPrintsATableRowPerEstimator) {
  const std::string yaml =
      "scene: {corridor: {length: 10}}\n"
      "route: {stand_before: 2.5, points: [{name: a, x: 0, y: 0}, {name: b, x: 2, y: 0}]}\n";
  const Outcome outcome = aims("run " + scenario(yaml) + " --no-pictures --out here");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  for (const char* row :
       {"M_list(a-b) %", "\naims ", "\ntfs ", "\ntfs_clean ", "\nlio ", "\nleg "}) {
    EXPECT_NE(outcome.output.find(row), std::string::npos) << row << outcome.output;
  }
  EXPECT_TRUE(fs::exists(folder_.path() / "here" / "scores.json"));
  const Outcome again = aims("run my.yaml --no-pictures --out here");
  EXPECT_EQ(again.exit_code, 0) << again.output;
  EXPECT_NE(again.output.find("0 jobs done, 7 found finished"), std::string::npos) << again.output;
}

TEST_F(CommandLine, DetectorsPrintsARowPerIndexAndSaysWhenNothingCanBeDetected) {
  const std::string yaml =
      "scene: {corridor: {length: 10}}\n"
      "route: {stand_before: 2.5, points: [{name: a, x: 0, y: 0}, {name: b, x: 1, y: 0}]}\n";
  const Outcome outcome =
      aims("study detectors " + scenario(yaml) + " --seeds 1 --quiet --out here");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  for (const char* row : {"\nD ", "\nO_lidar ", "\nC_IL ", "\nsmallest_eigenvalue "}) {
    EXPECT_NE(outcome.output.find(row), std::string::npos) << row << outcome.output;
  }
  EXPECT_NE(outcome.output.find("all runs, n10: none of"), std::string::npos) << outcome.output;
  EXPECT_EQ(outcome.output.find("nan"), std::string::npos) << outcome.output;
  EXPECT_TRUE(fs::exists(folder_.path() / "here" / "page.html"));
  EXPECT_EQ(aims("study detectors my.yaml --seeds 1 --out here").exit_code, 0) << "it continues";
  EXPECT_EQ(aims("study detectors my.yaml --seeds x --out new").exit_code, 2);
  EXPECT_EQ(aims("study detectors my.yaml --estimators leg --seeds 1 --out new").exit_code, 2);
}

TEST_F(CommandLine, AFailedExpectationExitsWithOne) {
  const std::string yaml =
      "scene: {corridor: {length: 10}}\n"
      "route: {stand_before: 2.5, points: [{name: a, x: 0, y: 0}, {name: b, x: 1, y: 0}]}\n"
      "expect: [{estimator: leg, score: m_end_m, max: 0.0}]\n";
  const Outcome outcome =
      aims("run " + scenario(yaml) + " --no-pictures --quiet --estimators leg --out here");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("my seed 1: leg m_end_m"), std::string::npos) << outcome.output;
}

TEST_F(CommandLine, BadConfigurationIsNamedByFileLineColumnAndKey) {
  expect_refused(scenario("lidar:\n  range_mx: 30\n"), "my.yaml:2:3: unknown key 'lidar.range_mx'");
  expect_refused(scenario("lidar:\n  range_mx: 30\n"), "did you mean 'lidar.range_max'?");
  expect_refused(scenario("lidar:\n  range_max: far\n"), "my.yaml:2:14");
  expect_refused(scenario("lidar:\n  range_max: -3\n"), "lidar.range_max");
  expect_refused(scenario("seed: 1\nseed: 2\n"), "my.yaml:2:1");
  expect_refused(scenario("lidar: [1, 2\n"), "my.yaml:");
}

TEST_F(CommandLine, BadUsageIsRefused) {
  expect_refused("nowhere.yaml", "nowhere.yaml");
  expect_refused(kCorridor + " --set lidar.range_mx=3", "did you mean 'lidar.range_max'?");
  expect_refused(kCorridor + " --set lidar.range_max", "--set");
  expect_refused(kCorridor + " --estimators aims,lioo", "did you mean 'lio'?");
  expect_refused(kCorridor + " --estimators aims,lioo", "aims run: --estimators: no estimator");
  expect_refused(kCorridor + " --seeds x", "--seeds");
  expect_refused(kCorridor + " --out /proc/nowhere/run", "/proc/nowhere");
}

TEST_F(CommandLine, ImpossibleScenariosAreRefused) {
  expect_refused(scenario("route: {points: [{name: a, x: 0, y: 1.1}, {name: b, x: 5, y: 1.1}]}\n"),
                 "my.yaml:1:18: route.points.0: ");
  expect_refused(scenario("route: {points: [{name: a, x: 0, y: 0}, {name: b, x: 0, y: 0}]}\n"),
                 "my.yaml:1:");
  expect_refused(scenario("scene: {corridor: {doors: {width: 3, spacing: 2}}}\n"), "my.yaml:1:");
  expect_refused(scenario("run: [aims, lioo]\n"), "my.yaml:1:6: run: no estimator");
  expect_refused(scenario("base: missing.yaml\n"), "missing.yaml");
}

TEST_F(CommandLine, ListAndConfigShowWhatThereIs) {
  const Outcome list = aims("list --folder '" AIMS_SCENARIOS "'");
  EXPECT_EQ(list.exit_code, 0);
  EXPECT_NE(list.output.find("corridor_smooth"), std::string::npos) << list.output;
  EXPECT_EQ(list.output.find("does not load"), std::string::npos) << list.output;
  EXPECT_NE(list.output.find("tfs_clean"), std::string::npos);
  const Outcome config = aims("config " + kCorridor);
  EXPECT_EQ(config.exit_code, 0);
  for (const char* key : {"eta:", "kappa:", "alpha:", "sigma_0:", "w1:", "gamma_min:"}) {
    EXPECT_NE(config.output.find(key), std::string::npos) << key;
  }
}

TEST_F(CommandLine, ListShowsFamiliesAndTakesSeveralTags) {
  const fs::path deep = folder_.path() / "scenarios" / "deep";
  fs::create_directories(deep);
  std::ofstream(deep / "mild.yaml") << "{tags: [one], family: loss, level: 1, level_unit: '%'}";
  std::ofstream(deep / "hard.yaml") << "{tags: [two], family: loss, level: 9, level_unit: '%'}";
  std::ofstream(deep / "other.yaml") << "tags: [three]";
  const Outcome list = aims("list --tags two,one");
  EXPECT_EQ(list.exit_code, 0) << list.output;
  EXPECT_NE(list.output.find("loss             [%], 2 scenarios: mild, hard"), std::string::npos)
      << list.output;
  EXPECT_EQ(list.output.find("other"), std::string::npos) << list.output;
  for (const char* none : {"nowhere", "scenarios/deep/mild.yaml"}) {
    const Outcome no_folder = aims(std::string("list --folder ") + none);
    EXPECT_EQ(no_folder.exit_code, 2) << no_folder.output;
    EXPECT_NE(no_folder.output.find("expected a folder of scenarios"), std::string::npos)
        << no_folder.output;
  }
  const Outcome unknown = aims("list --tags four");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.output.find("'four'; there are one, three, two"), std::string::npos);
}

TEST_F(CommandLine, ASuiteRunsResumesChecksItsExpectationsAndIsCompared) {
  fs::create_directories(folder_.path() / "scenarios");
  std::ofstream(folder_.path() / "scenarios" / "walk.yaml")
      << "tags: [short]\nscene: {corridor: {length: 10}}\n"
         "route: {stand_before: 2.5, points: [{name: a, x: 0, y: 0}, {name: b, x: 1, y: 0}]}\n"
         "expect: [{estimator: leg, score: ate_m, statistic: median, min: 50}]\n";
  const std::string suite = "suite --tags short --seeds 1-2 --estimators leg --out here";
  const Outcome first = aims(suite);
  EXPECT_EQ(first.exit_code, 1) << first.output;
  EXPECT_NE(first.output.find("2 jobs done, 0 found finished, 2 sequences simulated"),
            std::string::npos)
      << first.output;
  EXPECT_NE(first.output.find("walk seed 1,2: leg median ate_m"), std::string::npos);
  EXPECT_NE(
      first.output.find("to repeat: aims run scenarios/walk.yaml --seeds 1,2 --estimators leg"),
      std::string::npos)
      << first.output;
  EXPECT_NE(aims(suite).output.find("0 jobs done, 2 found finished"), std::string::npos);
  const std::string lag = " --set estimators.leg.queue.lag=0.1";
  const Outcome refused = aims(suite + lag);
  EXPECT_EQ(refused.exit_code, 2) << refused.output;
  EXPECT_NE(refused.output.find("here: holds results with no --set"), std::string::npos)
      << refused.output;
  const Outcome changed = aims(suite + lag + " --overwrite");
  EXPECT_NE(changed.output.find("2 jobs done, 0 found finished, sequences from the cache"),
            std::string::npos)
      << changed.output;
  const Outcome same = aims("study compare here here --fail-on-worse --out compared");
  EXPECT_EQ(same.exit_code, 0) << same.output;
  EXPECT_NE(same.output.find("0 better, 0 worse"), std::string::npos) << same.output;
  EXPECT_TRUE(fs::exists(folder_.path() / "compared" / "compare.json"));
}

TEST_F(CommandLine, ASuiteSaysWhatIsWrongWithItsArguments) {
  fs::create_directories(folder_.path() / "scenarios");
  std::ofstream(folder_.path() / "scenarios" / "walk.yaml") << "tags: [short]";
  const auto refused = [&](const std::string& arguments, const std::string& expected) {
    const Outcome outcome = aims(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
    EXPECT_NE(outcome.output.find(expected), std::string::npos) << outcome.output;
  };
  refused("suite --tags tall", "no scenario has the tag 'tall'; there are short");
  refused("suite --scenarios wlak", "did you mean 'walk'?");
  refused("suite --seeds 3-1", "'3-1' is not a seed");
  refused("suite --set lidar.range_mx=3", "did you mean 'lidar.range_max'?");
  refused("suite --tags short --out scenarios", "exists and is no folder of aims results");
  refused("suite --folder nowhere", "nowhere: holds no scenario");
  refused("study compare scenarios scenarios", "holds no finished results");
}

TEST_F(CommandLine, HelpAndVersionSucceedAndNonsenseDoesNot) {
  EXPECT_EQ(aims("--help").exit_code, 0);
  EXPECT_EQ(aims("run --help").exit_code, 0);
  EXPECT_EQ(aims("--version").exit_code, 0);
  EXPECT_EQ(aims("").exit_code, 2);
  EXPECT_EQ(aims("fly").exit_code, 2);
  EXPECT_EQ(aims("run --jobs none x").exit_code, 2);
}

}  // namespace
}  // namespace aims
