// SPDX-License-Identifier: BSD-3-Clause
// `aims score`, run as a user would.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Outcome;

/// Three metres of a corridor and back.
/// Clocks are right: between the poses of truth.tum, 10 ms apart, the truth is interpolated.
const std::string kShortWalk =
    "scene: {corridor: {length: 10}}\n"
    "route: {stand_before: 2.5, points: [{name: a, x: 0, y: 0}, {name: b, x: 3, y: 0},\n"
    "                                    {name: a, x: 0, y: 0}]}\n"
    "links: {lidar: {clock_offset_sigma: 0, clock_drift_sigma: 0}}\n";

class Score : public testing::CommandLine {
 protected:
  json scores_in(const std::string& folder) const {
    std::ifstream stream(folder_.path() / folder / "scores.json");
    return json::parse(stream);
  }

  /// Lines "stamp x y z qx qy qz qw" along x at 1 m/s times `scale`, from `start` [s] on.
  static std::string line(double start, double scale) {
    std::string text;
    for (int i = 0; i <= 200; ++i) {
      text += fmt::format("{:.1f} {} 0 0 0 0 0 1\n", start + 0.1 * i, 0.1 * i * scale);
    }
    return text;
  }

  static void expect_says(const Outcome& outcome, std::initializer_list<const char*> words) {
    for (const char* each : words) {
      EXPECT_NE(outcome.output.find(each), std::string::npos) << each << "\n" << outcome.output;
    }
  }

  /// Exit 2, one line that holds all of the words, and nothing written.
  void expect_refused(const std::string& arguments,
                      std::initializer_list<const char*> words) const {
    const Outcome outcome = aims("score " + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    expect_says(outcome, words);
    EXPECT_FALSE(fs::exists(folder_.path() / "out"));
  }
};

TEST_F(Score, OfARunsOwnFilesIsWhatTheRunScored) {
  const Outcome run = aims("run " + scenario(kShortWalk) +
                           " --estimators aims,leg --no-pictures --quiet --out run");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const Outcome score = aims(
      "score --truth run/truth.tum --estimate run/aims.tum --estimate "
      "run/leg.tum --waypoint-times run/waypoint_times.csv --config run/config.yaml "
      "--out scored");
  ASSERT_EQ(score.exit_code, 0) << score.output;
  expect_says(score, {"M_list(a-b) %", "M_list(b-a) %", "\naims ", "\nleg ", "trajectories.png"});
  const json before = scores_in("run");
  const json after = scores_in("scored");
  for (const char* name : {"aims", "leg"}) {
    const json& direct = before["estimators"][name];
    const json& scored = after["estimators"][name];
    EXPECT_EQ(scored["success"], direct["success"]);
    EXPECT_EQ(scored["poses"], direct["poses"]);
    // The file holds the truth at 100 Hz, the run had it at the physics' rate.
    for (const char* key : {"ate_m", "ate_yaw_m", "ate_se3_m", "m_end_m", "max_error_m"}) {
      EXPECT_NEAR(scored[key].get<double>(), direct[key].get<double>(), 1e-9) << key;
    }
    for (const char* segment : {"a-b", "b-a", "all"}) {
      EXPECT_NEAR(scored["m_list_percent"][segment].get<double>(),
                  direct["m_list_percent"][segment].get<double>(), 0.01)
          << segment;
    }
  }
  const Outcome compared = aims("study compare scored scored");
  EXPECT_EQ(compared.exit_code, 0) << compared.output;
}

TEST_F(Score, TakesTruthAndEstimatesFromABag) {
  const Outcome made = aims("simulate " + scenario(kShortWalk) + " --quiet --out walk.bag");
  ASSERT_EQ(made.exit_code, 0) << made.output;
  EXPECT_EQ(made.output, "") << "--quiet";
  expect_refused("--truth walk.bag --estimate walk.bag:/nope",
                 {"no topic /nope; there are", "/ground_truth/lidar (nav_msgs/Odometry)"});
  const std::string both =
      "score --truth walk.bag --estimate walk.bag:/ground_truth/lidar --estimate "
      "walk.bag:/leg_odometry --no-pictures --overwrite --out here";
  const Outcome score = aims(both);
  ASSERT_EQ(score.exit_code, 0) << score.output;
  expect_says(score, {"topic /ground_truth/imu chosen of several",
                      "poses of 'lidar', while the truth's are of 'imu'", "M_list(b-a) %",
                      "walk/leg_odometry"});
  EXPECT_GT(scores_in("here")["estimators"]["walk/ground_truth/lidar"]["ate_m"], 1e-3);
  // The LiDAR on the IMU, as the bag's /tf_static has it.
  ASSERT_EQ(aims(both + " --extrinsic '0.03 0 0.16 0 0 0 1'").exit_code, 0);
  EXPECT_LT(scores_in("here")["estimators"]["walk/ground_truth/lidar"]["ate_m"], 1e-9);
}

TEST_F(Score, StraightMotionSaysThatEvoGivesNoSe3) {
  write("truth.tum", line(0.0, 1.0));
  write("mine.tum", line(0.0, 1.1));
  const Outcome outcome = aims(
      "score --truth truth.tum --estimate mine.tum --name yours "
      "--segments there=0:20 --out here");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  expect_says(outcome, {"M_list(there) %", "10.000", " line", "note: yours: too straight",
                        "the rotation about their line from the first pose"});
  const json scores = scores_in("here");
  EXPECT_EQ(scores["estimators"]["yours"]["alignment"]["se3"], "line");
  EXPECT_EQ(scores["notes"].size(), 1U);
  std::ifstream markdown(folder_.path() / "here" / "scores.md");
  const std::string text((std::istreambuf_iterator<char>(markdown)), {});
  EXPECT_NE(text.find("about their line from the first pose"), std::string::npos) << text;
}

TEST_F(Score, BadInputIsOneLineThatNamesIt) {
  write("truth.tum", line(0.0, 1.0));
  write("late.tum", line(1.6e9, 1.0));
  write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  write("broken.tum", "1 0 0 0 0 0 0 1\n2 0 0\n");
  write("text.bag", "not a bag\n");
  const std::string truth = "--truth truth.tum ";
  expect_refused(truth + "--estimate late.tum",
                 {"late.tum", "0.000 to 20.000 s", "1600000000.000 to", "clock offset"});
  expect_refused(truth + "--estimate broken.tum", {"broken.tum:2: expected 8 columns"});
  expect_refused(truth + "--estimate poses.txt", {"poses.txt: 1 KITTI poses", "201", "--times"});
  expect_refused(truth + "--estimate text.bag:/odom", {"text.bag", "expected a ROS 1 bag"});
  expect_refused(truth + "--estimate none.tum", {"none.tum: cannot be read"});
  expect_refused(truth + "--estimate truth.tum --segments a-b=1", {"'a-b=1': expected NAME="});
  expect_refused(truth + "--estimate truth.tum --set scoring.ancor=pose", {"scoring.anchor"});
  expect_refused(truth + "--estimate truth.tum --config none.yaml", {"none.yaml"});
  EXPECT_EQ(aims("score --truth truth.tum").exit_code, 2);
}

TEST_F(Score, NothingToCompareIsAnErrorThatSaysWhatIsMissing) {
  write("truth.tum", line(0.0, 1.0));
  std::string invalid;
  for (int i = 0; i <= 200; ++i) invalid += fmt::format("{:.1f} nan 0 0 0 0 0 1\n", 0.1 * i);
  write("invalid.tum", invalid);
  write("one.tum", "3 1 0 0 0 0 0 1\n");
  expect_refused("--truth truth.tum --estimate truth.tum --estimate invalid.tum --name mine,theirs",
                 {"invalid.tum: expected at least two poses", "of 201 poses, 0 are valid"});
  expect_refused("--truth truth.tum --estimate one.tum", {"one.tum", "found 1: of 1 poses, 1 are"});
}

TEST_F(Score, AnEstimateOfASmallPartIsLoudAndNoSuccess) {
  write("truth.tum", line(0.0, 1.0));
  std::string few;
  for (int i = 0; i <= 200; ++i) {
    few +=
        fmt::format("{:.1f} {} 0 0 0 0 0 1\n", 0.1 * i, i < 5 ? fmt::format("{}", 0.1 * i) : "nan");
  }
  write("few.tum", few);
  const std::string score = "score --truth truth.tum --estimate few.tum --no-pictures --out here";
  const Outcome outcome = aims(score);
  EXPECT_EQ(outcome.exit_code, 4) << outcome.output;
  expect_says(outcome, {"few: covers 2.0 % of the truth's time", "less than scoring.min_coverage",
                        "196 of 201 poses left out", " 2 % "});
  const json scores = scores_in("here")["estimators"]["few"];
  EXPECT_FALSE(scores["success"]);
  EXPECT_NEAR(scores["coverage"].get<double>(), 0.02, 1e-9);
  const Outcome asked = aims(score + " --overwrite --set scoring.min_coverage=0");
  EXPECT_EQ(asked.exit_code, 0) << "a part on purpose\n" << asked.output;
}

TEST_F(Score, ComparedOnOneSeedHasATableAndNoVerdict) {
  write("truth.tum", line(0.0, 1.0));
  write("mine.tum", line(0.0, 1.01));
  const std::string score = "score --truth truth.tum --no-pictures --name mine --estimate ";
  ASSERT_EQ(aims(score + "truth.tum --out before").exit_code, 0);
  ASSERT_EQ(aims(score + "mine.tum --out after").exit_code, 0);
  const Outcome compared = aims("study compare before after --out compared");
  EXPECT_EQ(compared.exit_code, 0) << compared.output;
  expect_says(compared, {"change [95 %]", "too few",
                         "1 pair: the smallest p that this test can "
                         "reach is 1: no verdict",
                         "0 better, 0 worse"});
  std::ifstream stream(folder_.path() / "compared" / "compare.json");
  EXPECT_EQ(json::parse(stream)["schema"], "aims.compare/3");
  const Outcome gate = aims("study compare before after --fail-on-worse");
  EXPECT_EQ(gate.exit_code, 2) << "a gate that cannot fail is none";
  expect_says(
      gate, {"expected at least 6 common seeds where results differ; truth, mine: 1 pair of runs"});
  ASSERT_EQ(
      aims("score --truth truth.tum --no-pictures --name other --estimate truth.tum --out other")
          .exit_code,
      0);
  const Outcome gone = aims("study compare before other --fail-on-worse");
  EXPECT_EQ(gone.exit_code, 2) << gone.output;
  expect_says(gone, {"other has no valid run of truth, mine to compare with"});
}

TEST_F(Score, OnlyTheTruthIsCalledTruth) {
  write("truth.tum", line(0.0, 1.0));
  write("mine.tum", line(0.0, 1.1));
  expect_refused("--truth truth.tum --estimate truth.tum",
                 {"truth.tum", "'truth' is the name of the truth; give another with --name"});
  expect_refused("--truth truth.tum --estimate mine.tum --name truth", {"--name"});
}

TEST_F(Score, ANarrowTerminalWrapsWhatItLeavesOut) {
  write("truth.tum", line(0.0, 1.0));
  write("mine.tum", line(0.0, 1.1));
  const Outcome outcome = shell("COLUMNS=50 '" AIMS_COMMAND
                                "' score --truth truth.tum --estimate mine.tum --no-pictures "
                                "--no-page --quiet --out narrow");
  const std::size_t begin = outcome.output.find("in scores.md alone: ");
  ASSERT_NE(begin, std::string::npos) << outcome.output;
  std::istringstream lines(outcome.output.substr(begin));
  std::string line;
  for (int i = 0; i < 2 && std::getline(lines, line); ++i) EXPECT_LE(line.size(), 50U) << line;
  EXPECT_TRUE(line.starts_with("  ")) << outcome.output;
}

TEST_F(Score, ResultsAreNotReplacedUnasked) {
  write("truth.tum", line(0.0, 1.0));
  const std::string score =
      "score --truth truth.tum --estimate truth.tum --name mine --no-pictures --out here";
  EXPECT_EQ(aims(score).exit_code, 0);
  EXPECT_EQ(aims(score).exit_code, 2);
  EXPECT_EQ(aims(score + " --overwrite").exit_code, 0);
}

}  // namespace
}  // namespace aims
