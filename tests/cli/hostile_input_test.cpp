// SPDX-License-Identifier: BSD-3-Clause
// Names that hold any bytes, paths that lead nowhere, output that cannot be written: as a user
// meets them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "core/files/atomic_file.hpp"
#include "core/text.hpp"
#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Outcome;

class HostileInput : public testing::CommandLine {
 protected:
  json document(const std::string& file) const {
    return json::parse(read_file(folder_.path() / file).value());
  }

  /// walk.bag of a metre of a corridor.
  void simulate() const {
    const Outcome made = aims("simulate " + scenario(testing::kMetreWalk) + " --out walk.bag");
    ASSERT_EQ(made.exit_code, 0) << made.output;
  }

  /// `to`, a copy of the bag with other bytes of the same length in place of a topic's name.
  void rename_topic(const std::string& from, const std::string& name, const std::string& to) const {
    ASSERT_EQ(from.size(), name.size());
    std::string bytes = read_file(folder_.path() / "walk.bag").value();
    for (std::size_t at = bytes.find(from); at != std::string::npos; at = bytes.find(from, at)) {
      bytes.replace(at, name.size(), name);
    }
    write(to, bytes);
  }

  static void expect_shown_safely(const Outcome& outcome) {
    EXPECT_EQ(outcome.output, terminal_text(outcome.output));
  }
};

TEST_F(HostileInput, ResultsAreWrittenWhateverAFileNameHolds) {
  write("caf\xE9.yaml", testing::kMetreWalk);
  const Outcome run = aims("run 'caf\xE9.yaml' --estimators lio --no-pictures --quiet --out run");
  EXPECT_EQ(run.exit_code, 0) << run.output;
  expect_shown_safely(run);
  EXPECT_EQ(document("run/scores.json").at("scenario"), "caf\\xe9");
  const Outcome suite = aims("suite 'caf\xE9.yaml' --seeds 1 --estimators lio --quiet --out suite");
  EXPECT_EQ(suite.exit_code, 0) << suite.output;
  EXPECT_NE(document("suite/suite.json").dump().find("caf\\\\xe9"), std::string::npos);
}

TEST_F(HostileInput, ResultsAreWrittenWhateverAScenarioHolds) {
  std::string yaml = testing::kMetreWalk;
  yaml.replace(yaml.find("name: b"), 7, "name: \"b\xFF\"");
  const Outcome run =
      aims("run " + scenario(yaml) + " --estimators lio --no-pictures --quiet --out run");
  EXPECT_EQ(run.exit_code, 0) << run.output;
  expect_shown_safely(run);
  EXPECT_TRUE(document("run/scores.json").contains("estimators"));
}

TEST_F(HostileInput, ResultsAreWrittenWhateverATopicHolds) {
  simulate();
  rename_topic("/leg_odometry", "/leg\xFF\x1B[31mtry", "bad.bag");
  const Outcome info = aims("info bad.bag");
  EXPECT_EQ(info.exit_code, 0) << info.output;
  EXPECT_TRUE(holds(info, "/leg\\xff\\x1b[31mtry")) << info.output;
  expect_shown_safely(info);
  expect_shown_safely(aims("check bad.bag"));
  expect_shown_safely(aims("estimate bad.bag --topics lidar=/none"));
  const Outcome estimate = aims(
      "estimate bad.bag --no-pictures --quiet --out est "
      "--topics 'leg_odometry=/leg\xFF\x1B[31mtry'");
  EXPECT_EQ(estimate.exit_code, 0) << estimate.output;
  expect_shown_safely(estimate);
  EXPECT_EQ(document("est/estimate.json").at("topics").at("leg_odometry"), "/leg\\xff\x1B[31mtry");
}

TEST_F(HostileInput, ResultsAreWrittenWhateverALabelHolds) {
  simulate();
  const Outcome score =
      aims("score --truth walk.truth.tum --estimate walk.truth.tum --name 'n\xFF' --out sc");
  EXPECT_EQ(score.exit_code, 0) << score.output;
  expect_shown_safely(score);
  EXPECT_TRUE(document("sc/scores.json").at("estimators").contains("n\\xff"));
}

TEST_F(HostileInput, OutputThatCannotBeWrittenIsAnError) {
  simulate();
  for (const char* line : {"info walk.bag", "check walk.bag", "list", "config", "--help"}) {
    const Outcome outcome = shell("('" AIMS_COMMAND "' " + std::string(line) + " 2>&1 >/dev/full)");
    EXPECT_EQ(outcome.exit_code, 2) << line;
    EXPECT_TRUE(holds(outcome, "standard output cannot be written")) << line << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << line;
  }
}

TEST_F(HostileInput, WithoutSpaceTheRecordedPartOfABagStays) {
  write("my.yaml", testing::kMetreWalk);
  write("walk.bag", "an older file");
  const std::string simulate =
      "'" AIMS_COMMAND "' simulate my.yaml --set lidar.columns=900 --quiet --out walk.bag";
  // As a full disk does, a limit refuses to write more.
  const Outcome outcome =
      shell("(trap '' XFSZ; prlimit --fsize=16000000 " + simulate + " --overwrite)");
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
  EXPECT_TRUE(holds(outcome, "cannot be written")) << outcome.output;
  EXPECT_TRUE(holds(outcome, "is in walk.bag.partial")) << outcome.output;
  EXPECT_EQ(read_file(folder_.path() / "walk.bag").value(), "an older file");
  const Outcome info = aims("info walk.bag.partial");
  EXPECT_EQ(info.exit_code, 0) << info.output;
  EXPECT_TRUE(holds(info, "/imu/data")) << info.output;
  fs::remove(folder_.path() / "walk.bag");
  const Outcome again = shell(simulate);
  EXPECT_EQ(again.exit_code, 2) << "without --overwrite nothing recorded is lost";
  EXPECT_TRUE(holds(again, "walk.bag.partial")) << again.output;
  EXPECT_EQ(shell(simulate + " --overwrite").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder_.path() / "walk.bag.partial"));
}

TEST_F(HostileInput, TheNameOfARecordingStatesItsFormat) {
  const std::string walk = scenario(testing::kMetreWalk);
  for (const char* name : {"walk.txt", "walk", "walk.bag.gz"}) {
    const Outcome outcome = aims("simulate " + walk + " --out " + name);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
    EXPECT_TRUE(holds(outcome, "expected a name that ends in .bag, .mcap, or /")) << outcome.output;
    EXPECT_FALSE(fs::exists(folder_.path() / name));
  }
}

TEST_F(HostileInput, APathThatCannotBeFollowedIsBadInput) {
  fs::create_symlink("loop", folder_.path() / "loop");
  write("my.yaml", testing::kMetreWalk);
  for (const std::string& path : {std::string("loop"), std::string(300, 'x')}) {
    for (const std::string line :
         {"run ", "estimate ", "page ", "merge ", "config ", "render ",
          "run my.yaml --estimators lio --out ", "render my.yaml --out ", "info "}) {
      const Outcome outcome = aims(line + path);
      EXPECT_EQ(outcome.exit_code, 2) << line << path << "\n" << outcome.output;
      EXPECT_TRUE(holds(outcome, path.substr(0, 40))) << line << outcome.output;
      EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1)
          << line << outcome.output;
    }
  }
}

TEST_F(HostileInput, APipeOrADeviceIsNoInput) {
  simulate();
  ASSERT_EQ(shell("mkfifo pipe pipe.csv && mkdir folder && mkfifo folder/metadata.yaml").exit_code,
            0);
  write("table.yaml", "file: pipe.csv\ntime: t\n");
  const std::string truth = "score --truth walk.truth.tum --estimate ";
  for (const std::string& line :
       {std::string("info pipe"), std::string("info folder"), std::string("estimate table.yaml"),
        std::string("estimate walk.bag --config pipe"), truth + "pipe", truth + "/dev/zero",
        truth + "walk.truth.tum --waypoint-times pipe",
        std::string("score --truth pipe --estimate walk.truth.tum")}) {
    const Outcome outcome = aims(line);
    EXPECT_EQ(outcome.exit_code, 2) << line;
    EXPECT_TRUE(holds(outcome, "expected a regular file")) << line << outcome.output;
  }
}

TEST_F(HostileInput, StampsCannotBeMovedBeyondTheirRange) {
  simulate();
  for (const char* offset : {"1e12", "-1e300", "nan", "inf"}) {
    const Outcome outcome = aims(
        "score --truth walk.truth.tum --estimate walk.truth.tum "
        "--time-offset " +
        std::string(offset));
    EXPECT_EQ(outcome.exit_code, 2) << offset;
    EXPECT_TRUE(holds(outcome, "--time-offset: ")) << outcome.output;
  }
}

TEST_F(HostileInput, LimitsOfTheShellAreErrorsNotSignals) {
  simulate();
  for (const char* line : {"simulate my.yaml --out v.bag", "convert walk.bag -o v.mcap",
                           "estimate walk.bag --estimators leg --no-page --out v"}) {
    const Outcome outcome = shell("(ulimit -f 64; '" AIMS_COMMAND "' " + std::string(line) + ")");
    EXPECT_EQ(outcome.exit_code, 2) << line << outcome.output;
    EXPECT_TRUE(holds(outcome, "File too large")) << line << outcome.output;
  }
  // More or less memory than this fails elsewhere, but never by a signal.
  const Outcome outcome =
      shell("(ulimit -v 400000; '" AIMS_COMMAND "' simulate my.yaml --out w.bag)");
  EXPECT_LT(outcome.exit_code, 128) << outcome.output;
}

TEST_F(HostileInput, ALongValueIsNotEchoedWhole) {
  std::ofstream(folder_.path() / "long.yaml") << "seed: " << std::string(400'000, 'a') << "\n";
  const Outcome outcome = aims("run long.yaml");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_LT(outcome.output.size(), 1000U);
  EXPECT_TRUE(holds(outcome, "long.yaml:1:7: seed: ")) << outcome.output;
  EXPECT_TRUE(holds(outcome, "(400002 bytes)")) << outcome.output;
}

}  // namespace
}  // namespace aims
