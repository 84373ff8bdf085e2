// SPDX-License-Identifier: BSD-3-Clause
// A robot that falls, through the real command: loud, with its own exit code, and in no statistic.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "bench/scoring/score_record.hpp"
#include "core/files/atomic_file.hpp"
#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::kMetreWalk;
using testing::Outcome;

const std::string kPush = "push: {count: 3, force: 500, duration: 0.5, start: 0, end: 5}\n";
const std::string kDemand = "expect: [{score: robot.fell, min: 1}]\n";

class InvalidRuns : public testing::CommandLine {
 protected:
  void SetUp() override {
    write("push.yaml", kMetreWalk + kPush);
    write("fall.yaml", kMetreWalk + kPush + kDemand);
    write("fine.yaml", kMetreWalk);
  }

  Json json(const fs::path& file) const {
    const auto text = read_file(folder_.path() / file);
    return text ? Json::parse(*text, nullptr, false) : Json();
  }
};

TEST_F(InvalidRuns, OfAFallenRobotAreLoudAndNoSuccess) {
  const Outcome run = aims("run push.yaml --estimators leg,aims --no-pictures --out out");
  EXPECT_EQ(run.exit_code, 4) << run.output;
  EXPECT_TRUE(holds(run, "INVALID RUN: push seed 1: the robot fell at ")) << run.output;
  EXPECT_FALSE(holds(run, " yes")) << run.output;
  const Json scores = json("out/scores.json");
  EXPECT_EQ(scores["robot"]["valid"], false);
  EXPECT_EQ(scores["robot"]["end"], "fell");
  for (const auto& [name, estimator] : scores["estimators"].items()) {
    EXPECT_EQ(estimator["success"], false) << name;
  }
}

TEST_F(InvalidRuns, AreNoDefectWhereTheFallIsTheTest) {
  const Outcome run = aims("run fall.yaml --estimators leg --no-pictures --no-page --out out");
  EXPECT_EQ(run.exit_code, 0) << run.output;
  EXPECT_FALSE(holds(run, "INVALID RUN")) << run.output;
  EXPECT_TRUE(holds(run, "as the scenario demands")) << run.output;
  const Outcome stands =
      aims("run fall.yaml --estimators leg --no-pictures --no-page --set push.count=0 --out two");
  EXPECT_EQ(stands.exit_code, 1) << stands.output;
  EXPECT_TRUE(holds(stands, "robot.fell = 0, expected at least 1")) << stands.output;
}

TEST_F(InvalidRuns, AreLeftOutOfASuite) {
  const Outcome suite = aims("suite push.yaml fine.yaml --estimators leg --no-page --out out");
  EXPECT_EQ(suite.exit_code, 4) << suite.output;
  EXPECT_TRUE(holds(suite, "INVALID RUN: push seed 1: the robot fell")) << suite.output;
  const Json scenarios = json("out/suite.json")["scenarios"];
  EXPECT_EQ(scenarios[0]["invalid"][0]["seed"], 1);
  EXPECT_TRUE(scenarios[0]["estimators"].empty());
  EXPECT_EQ(scenarios[1]["estimators"]["leg"]["successes"], 1);
  const auto markdown = read_file(folder_.path() / "out" / "suite.md");
  EXPECT_NE(markdown->find("push: 1 of 1 runs are invalid and left out: seed 1"),
            std::string::npos);
}

TEST_F(InvalidRuns, KeepTheBagOfASimulation) {
  const Outcome simulated = aims("simulate push.yaml --out push.bag --quiet");
  EXPECT_EQ(simulated.exit_code, 4) << simulated.output;
  EXPECT_TRUE(holds(simulated, "INVALID RUN: push seed 1: the robot fell")) << simulated.output;
  EXPECT_TRUE(fs::exists(folder_.path() / "push.bag"));
  EXPECT_EQ(aims("simulate fall.yaml --out fall.bag --quiet").exit_code, 0);
}

TEST_F(InvalidRuns, AreNoScoresOfASweepOrATuning) {
  const Outcome sweep =
      aims("sweep --scenarios push.yaml --estimators leg --param push.force=0:500:2 --out sweep");
  EXPECT_EQ(sweep.exit_code, 4) << sweep.output;
  EXPECT_TRUE(holds(sweep, "INVALID RUNS: 1 jobs")) << sweep.output;
  const Outcome merged = aims("merge sweep");
  EXPECT_EQ(merged.exit_code, 4) << merged.output;
  EXPECT_TRUE(holds(merged, "the robot fell at")) << merged.output;
  EXPECT_TRUE(holds(merged, "1 of 2 jobs done")) << merged.output;
  write("plan.yaml", "scenarios: [push.yaml]\nseeds: '1'\nparams: [\"degeneracy.eta=1:2\"]\n");
  const Outcome tune = aims("tune plan.yaml --out tune");
  EXPECT_EQ(tune.exit_code, 2) << tune.output;
  EXPECT_TRUE(holds(tune, "no valid run is left: push seed 1")) << tune.output;
}

TEST_F(InvalidRuns, IncludeARouteThatMaxDurationCuts) {
  const Outcome run =
      aims("run fine.yaml --estimators leg --no-pictures --no-page --set max_duration=3 --out out");
  EXPECT_EQ(run.exit_code, 4) << run.output;
  EXPECT_TRUE(holds(run, "INVALID RUN: fine seed 1: max_duration ended it at 3.0 s")) << run.output;
}

}  // namespace
}  // namespace aims
