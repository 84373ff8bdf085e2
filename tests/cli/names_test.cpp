// SPDX-License-Identifier: BSD-3-Clause
// Texts of a user that become names of files, and options that are given without a value.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::kMetreWalk;
using testing::Outcome;

class Names : public testing::CommandLine {
 protected:
  /// Refused with one line that holds `expected`; nothing is written outside the folder.
  void expect_refused(const std::string& command, const std::string& expected) const {
    const Outcome outcome = aims(command);
    EXPECT_EQ(outcome.exit_code, 2) << command << "\n" << outcome.output;
    EXPECT_TRUE(holds(outcome, expected)) << command << "\n" << outcome.output;
    EXPECT_FALSE(fs::exists(folder_.path() / "out")) << command;
    EXPECT_FALSE(fs::exists(folder_.path().parent_path() / "evil")) << command;
  }
};

TEST_F(Names, OfAScenarioCannotLeaveTheFolderOfResults) {
  write("evil.yaml", "name: ../../evil\n" + kMetreWalk);
  for (const char* command :
       {"run evil.yaml", "suite evil.yaml --trajectories --out out/suite",
        "sweep --scenarios evil.yaml --param degeneracy.eta=1:2:2 --out out/sweep",
        "study ablation evil.yaml --out out/ablation", "simulate evil.yaml --out out/walk.bag"}) {
    expect_refused(command, "evil.yaml:1:7: name: expected a name that a file can have");
  }
  write("plan.yaml", "scenarios: [evil.yaml]\nparams: [\"degeneracy.eta=1:2\"]\n");
  expect_refused("tune plan.yaml --out out/tune", "name: expected a name that a file can have");
  expect_refused("run evil.yaml --set name=/tmp/evil", "it holds a separator");
  write("red.yaml", "name: \"\\e[2J\"\n" + kMetreWalk);
  expect_refused("run red.yaml", "got '\\x1b[2J': it holds a control character");
  expect_refused("run evil.yaml --set name=" + std::string(101, 'x'), "101 bytes");
}

TEST_F(Names, OfFamiliesAndLabelsCannotEither) {
  write("my.yaml", kMetreWalk);
  expect_refused("suite my.yaml --set family=../evil --out out/suite", "family: expected a name");
  expect_refused("run my.yaml --estimators ../evil=leg", "the label '../evil'");
  expect_refused("run my.yaml --estimators -x=leg", "it begins with '-'");
  const std::string longest(101, 'x');
  expect_refused("run my.yaml --estimators " + longest + "=leg", "101 bytes");
  expect_refused("score --truth a.tum --estimate a.tum --name ../evil --out out/score",
                 "--name: expected a name that a file can have, got '../evil'");
}

TEST_F(Names, OptionsGivenAsNothingAreRefusedByName) {
  write("my.yaml", kMetreWalk);
  for (const char* option : {"--seeds", "--out", "--estimators", "--cache", "--folder"}) {
    expect_refused("run my.yaml " + std::string(option) + " ''",
                   std::string(option) + ": expected a value");
  }
  expect_refused("suite my.yaml --tags ''", "--tags: expected a value");
  expect_refused("run my.yaml --set run=[]", "run: expected at least one estimator");
  write("none.yaml", kMetreWalk + "run: []\n");
  expect_refused("run none.yaml", "none.yaml:4:6: run: expected at least one estimator");
}

TEST_F(Names, OfAScoreIsFoundUnknownBeforeTheWalk) {
  write("my.yaml", kMetreWalk + "expect: [{estimator: leg, score: m_list_percent.a-c, max: 1}]\n");
  expect_refused("run my.yaml", "my.yaml:4:34: expect.0.score: no score 'm_list_percent.a-c'");
  expect_refused("run my.yaml", "did you mean 'm_list_percent.a-b'?");
  write("plan.yaml",
        "scenarios: [ok.yaml]\nparams: [\"degeneracy.eta=1:2\"]\n"
        "objectives: [{score: ate}]\n");
  write("ok.yaml", kMetreWalk);
  expect_refused("tune plan.yaml --out out/tune", "objectives.0.score: no score 'ate'");
}

}  // namespace
}  // namespace aims
