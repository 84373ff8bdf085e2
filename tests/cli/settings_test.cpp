// SPDX-License-Identifier: BSD-3-Clause
// What a user may write in a setting or a file, and what is said of what is wrong there.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/files/atomic_file.hpp"
#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::Outcome;

class Settings : public testing::CommandLine {
 protected:
  void expect_refused(const std::string& arguments, const std::string& expected) const {
    const Outcome outcome = aims(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
    EXPECT_TRUE(holds(outcome, expected)) << outcome.output;
  }
};

TEST_F(Settings, KeysThatBeginAlikeAreProposed) {
  expect_refused("config --set lidar.range=30",
                 "unknown key 'lidar.range'; did you mean 'lidar.range_min', 'lidar.range_max'");
  expect_refused("runn corridor", "unknown command 'runn'; did you mean 'aims run'?");
}

TEST_F(Settings, AKeyOfAnotherNameIsNotProposed) {
  expect_refused("config --set estimators.aims_d.nothing=1",
                 "unknown key 'estimators.aims_d.nothing'\n");
  expect_refused("config --set estimators.aimsd.degeneracy.eta=1",
                 "did you mean 'estimators.aims.degeneracy.eta'?");
}

TEST_F(Settings, LimitsOfSeedsAreNamed) {
  scenario(testing::kMetreWalk);
  expect_refused(
      "run my.yaml --seeds 1-99999999999",
      "99999999999 is too large; allowed are up to 10000 seeds, each at most 2147483647");
}

TEST_F(Settings, ATabIsCalledATab) {
  scenario("lidar:\n\trange_max: 30\n");
  expect_refused("config my.yaml", "my.yaml:2:1: a tab; YAML indents by spaces");
}

TEST_F(Settings, ABaseIsABareNameAsOnTheCommandLine) {
  const std::string folder = " --folder '" AIMS_SCENARIOS "'";
  scenario("base: corridor\nlidar: {range_max: 12.5}\n");
  const Outcome config = aims("config my.yaml --plain" + folder);
  EXPECT_EQ(config.exit_code, 0) << config.output;
  EXPECT_TRUE(holds(config, "tags: [paper, corridor]")) << "that of the base\n" << config.output;
  EXPECT_TRUE(holds(config, "range_max: 12.5")) << config.output;
  scenario("base: corridr\n");
  expect_refused("config my.yaml" + folder, "my.yaml:1:7: base: no such file");
}

TEST_F(Settings, ThePointsOfTheRouteAreSet) {
  scenario(testing::kMetreWalk);
  const std::string points = "--set 'route.points=[[a,0,0],[b,0.6,0],[a,0,0]]'";
  const std::string quick =
      " --estimators leg --no-pictures --no-page --quiet --set lidar.columns=50";
  const Outcome run = aims("run my.yaml " + points + quick + " --out here");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const auto config = read_file(folder_.path() / "here" / "config.yaml");
  ASSERT_TRUE(config);
  EXPECT_NE(config->find(
                "  points:\n    - name: a\n      x: 0\n      y: 0\n    - name: b\n      x: 0.6\n"),
            std::string::npos)
      << *config;
  const Outcome again = aims("config here/config.yaml --plain");
  EXPECT_EQ(again.exit_code, 0) << again.output;
  EXPECT_EQ(again.output, *config) << "the configuration loads and is written alike";
}

TEST_F(Settings, WhatIsWrongWithAPointIsNamed) {
  scenario(testing::kMetreWalk);
  expect_refused("config my.yaml --set 'route.points=[[a,0]]'",
                 "route.points.0: expected a map or a list [name, x, y], found 2 values");
  expect_refused("config my.yaml --set 'route.points=[[a,0,0],[b,far,0]]'",
                 "route.points.1.x: expected a number");
  expect_refused("config my.yaml --set route.points.7.x=1",
                 "no entry 7; route.points has 2, counted from 0");
  expect_refused("run my.yaml --set 'route.points=[[a,0,0]]'", "expected at least two points");
}

TEST_F(Settings, PathsInAPlanAreRelativeToIt) {
  fs::create_directories(folder_.path() / "plans");
  write("plans/walk.yaml", testing::kMetreWalk);
  write("plans/over.yaml", "lidar: {rings: 8}\n");
  write("plans/plan.yaml",
        "scenarios: [walk.yaml]\nset: [\"@over.yaml\"]\nestimators: [leg]\n"
        "params: [\"queue.max_ahead=100:200:2\"]\n");
  const Outcome list = aims("sweep plans/plan.yaml --list");
  EXPECT_EQ(list.exit_code, 0) << list.output;
  EXPECT_TRUE(holds(list, "walk seed 1 leg+queue.max_ahead=100")) << list.output;
}

}  // namespace
}  // namespace aims
