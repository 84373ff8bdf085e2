// SPDX-License-Identifier: BSD-3-Clause
// What commands remove from the folders of their results: their own files alone.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/files/atomic_file.hpp"
#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::Outcome;

class Overwrite : public testing::CommandLine {
 protected:
  bool exists(const char* name) const { return fs::exists(folder_.path() / name); }
};

TEST_F(Overwrite, EstimateReplacesItsOwnResultsAlone) {
  write("my.yaml", testing::kMetreWalk);
  ASSERT_EQ(aims("simulate my.yaml --out my.bag --quiet").exit_code, 0);
  const std::string command =
      "estimate my.bag --estimators leg --set recording.topics.truth=none --no-pictures --out est";
  fs::create_directory(folder_.path() / "est");
  const Outcome first = aims(command);
  EXPECT_EQ(first.exit_code, 0) << "an empty folder is as good as none: " << first.output;
  EXPECT_FALSE(exists("est/scores.json")) << "there was no truth";
  EXPECT_EQ(aims(command).exit_code, 2);
  write("est/a-note.txt", "mine");
  const Outcome again = aims(command + " --overwrite");
  EXPECT_EQ(again.exit_code, 0) << again.output;
  EXPECT_TRUE(exists("est/a-note.txt"));
  fs::remove(folder_.path() / "est" / ".aims-files");
  const Outcome refused = aims(command + " --overwrite");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(holds(refused, "est: has no .aims-files")) << refused.output;
  EXPECT_TRUE(holds(refused, "a-note.txt")) << refused.output;
  EXPECT_TRUE(exists("est/a-note.txt"));
}

TEST_F(Overwrite, RunRemovesOnlyTheTrajectoriesThatItWrote) {
  write("my.yaml", testing::kMetreWalk);
  const std::string command = "run my.yaml --no-pictures --no-page --out out --estimators ";
  ASSERT_EQ(aims(command + "leg,mine=leg").exit_code, 0);
  write("out/rival.tum", "0 0 0 0 0 0 0 1\n");
  ASSERT_EQ(aims(command + "leg").exit_code, 0);
  EXPECT_TRUE(exists("out/leg.tum"));
  EXPECT_FALSE(exists("out/mine.tum")) << "it does not run any more";
  EXPECT_TRUE(exists("out/rival.tum")) << "somebody else's";
}

TEST_F(Overwrite, ARunMadeAgainLeavesNoPictureAndNoPageOfTheOneBefore) {
  write("my.yaml", testing::kMetreWalk);
  const std::string command = "run my.yaml --estimators leg --out out --quiet";
  ASSERT_EQ(aims(command).exit_code, 0);
  ASSERT_TRUE(exists("out/trajectories.png"));
  ASSERT_TRUE(exists("out/page.html"));
  write("out/mine.png", "");
  const Outcome again = aims(command + " --set lidar.columns=450 --overwrite --no-pictures");
  EXPECT_EQ(again.exit_code, 0) << again.output;
  EXPECT_FALSE(holds(again, "trajectories.png")) << again.output;
  EXPECT_FALSE(exists("out/trajectories.png"));
  EXPECT_FALSE(exists("out/robot_start.png"));
  EXPECT_TRUE(exists("out/mine.png")) << "somebody else's";
  EXPECT_EQ(aims(command + " --overwrite --no-pictures --no-page").exit_code, 0);
  EXPECT_FALSE(exists("out/page.html"));
}

TEST_F(Overwrite, FewerSeedsLeaveNoSeedOfTheRunBefore) {
  write("my.yaml", testing::kMetreWalk);
  const std::string command = "run my.yaml --estimators leg --out out --quiet --no-pictures";
  ASSERT_EQ(aims(command + " --seeds 1-3").exit_code, 0);
  write("out/seed-3/a-note.txt", "mine");
  ASSERT_EQ(aims(command + " --seeds 1-2").exit_code, 0);
  const std::string page = read_file(folder_.path() / "out/page.html").value();
  EXPECT_NE(page.find("seeds 1–2"), std::string::npos) << "and not 1–3";
  EXPECT_FALSE(exists("out/seed-3/scores.json"));
  EXPECT_TRUE(exists("out/seed-3/a-note.txt")) << "somebody else's";
  ASSERT_EQ(aims(command + " --seeds 2").exit_code, 0);
  EXPECT_TRUE(exists("out/scores.json"));
  EXPECT_FALSE(exists("out/summary.md"));
  EXPECT_FALSE(exists("out/seed-1"));
  ASSERT_EQ(aims(command + " --seeds 1-3").exit_code, 0);
  EXPECT_FALSE(exists("out/scores.json"));
  EXPECT_TRUE(exists("out/seed-3/scores.json")) << "its jobs are still in the store";
}

TEST_F(Overwrite, ASuiteMadeAgainLeavesNoRunAndNoPageOfTheOneBefore) {
  write("my.yaml", testing::kMetreWalk);
  const std::string command = "suite my.yaml --estimators leg --out out --quiet";
  ASSERT_EQ(aims(command + " --seeds 1-2 --trajectories").exit_code, 0);
  ASSERT_TRUE(exists("out/page.html"));
  ASSERT_EQ(aims(command + " --seeds 2 --trajectories --no-page").exit_code, 0);
  EXPECT_FALSE(exists("out/page.html"));
  EXPECT_FALSE(exists("out/runs/my/seed-1"));
  EXPECT_TRUE(exists("out/runs/my/seed-2/scores.json"));
  ASSERT_EQ(aims(command + " --seeds 2").exit_code, 0);
  EXPECT_FALSE(exists("out/runs"));
}

TEST_F(Overwrite, TwoSuitesOnOneFolderSayThatItIsInUse) {
  fs::create_directories(folder_.path() / "out");
  write("my.yaml", testing::kMetreWalk);
  write("out/half-written", "");
  const Outcome second = shell("flock out/.lock '" AIMS_COMMAND "' suite my.yaml --out out");
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_TRUE(holds(second, "out: in use by another aims command")) << second.output;
  const Outcome alone = aims("suite my.yaml --out out");
  EXPECT_TRUE(holds(alone, "out: exists and is no folder of aims results")) << alone.output;
}

}  // namespace
}  // namespace aims
