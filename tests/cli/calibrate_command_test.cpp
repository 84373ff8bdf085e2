// SPDX-License-Identifier: BSD-3-Clause
// `aims calibrate` and --calibration, run as a user would.
#include <gtest/gtest.h>

#include "core/files/atomic_file.hpp"
#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

using testing::Outcome;

class Calibrate : public testing::CommandLine {};

/// Legs of the default robot.
constexpr const char* kRobot =
    "schema: aims.robot_calibration/1\n"
    "sensors:\n"
    "  legs: {hip_x: 0.188, hip_y: 0.047, abduction: 0.08, thigh: 0.213, calf: 0.213,\n"
    "         foot_radius: 0.022}\n"
    "  lidar_translation: [0.03, 0, 0.16]\n"
    "quantities:\n"
    "  - {name: joint_compliance, entries: [c], values: [0.2], covariance: [0.01], used: true}\n";

TEST_F(Calibrate, WritesWhatAShortWalkShows) {
  scenario(testing::kMetreWalk);
  const Outcome made = aims("calibrate my.yaml --robot-seed 3 --quiet -o robot.yaml");
  ASSERT_EQ(made.exit_code, 0) << made.output;
  EXPECT_TRUE(holds(made, "not observable")) << made.output;
  const std::string file = read_file(folder_.path() / "robot.yaml").value();
  EXPECT_NE(file.find("schema: aims.robot_calibration/1"), std::string::npos) << file;
  EXPECT_NE(file.find("my seed 1"), std::string::npos) << file;
  const Outcome again = aims("calibrate my.yaml --quiet -o robot.yaml");
  EXPECT_EQ(again.exit_code, 2) << again.output;
}

TEST_F(Calibrate, ARunStartsFromTheFileAndAnotherRobotIsAWarning) {
  scenario(testing::kMetreWalk);
  write("robot.yaml", kRobot);
  const std::string run = "run my.yaml --no-pictures --no-page --quiet --estimators aims_d ";
  const Outcome used = aims(run + "--robot-seed 3 --calibration robot.yaml --out used");
  EXPECT_EQ(used.exit_code, 0) << used.output;
  EXPECT_FALSE(holds(used, "warning")) << used.output;
  const std::string config = read_file(folder_.path() / "used" / "config.yaml").value();
  EXPECT_NE(config.find("joint_compliance: [0.2, 0.01]"), std::string::npos) << config;
  EXPECT_NE(config.find("robot_seed: 3"), std::string::npos) << config;
  const Outcome other =
      aims(run + "--set robot.legs.calf=0.23 --calibration robot.yaml --out other");
  EXPECT_TRUE(holds(other, "my: not the robot of the calibration robot.yaml: legs of other"))
      << other.output;
  EXPECT_TRUE(holds(other, "(calibration of another robot")) << other.output;
  const std::string rows = read_file(folder_.path() / "other" / "aims_d.health.csv").value();
  EXPECT_EQ(rows.find(",healthy,"), std::string::npos) << rows;
}

/// `text` with what it says of `part` replaced.
std::string with(std::string text, const std::string& part, const std::string& other) {
  return text.replace(text.find(part), part.size(), other);
}

TEST_F(Calibrate, SensorsAreComparedAfterTheSeedHasDrawnThem) {
  scenario(testing::kMetreWalk + "draw: [{key: leg_odometry.rate, values: ['400']}]\n");
  const std::string run =
      "run my.yaml --no-pictures --no-page --quiet --estimators aims_d --calibration robot.yaml "
      "--out ";
  write("robot.yaml", with(kRobot, "  lidar_tr", "  leg_rate: 400\n  lidar_tr"));
  const Outcome same = aims(run + "same");
  EXPECT_EQ(same.exit_code, 0) << same.output;
  EXPECT_FALSE(holds(same, "warning")) << same.output;
  write("robot.yaml", with(kRobot, "  lidar_tr", "  leg_rate: 100\n  lidar_tr"));
  const Outcome other = aims(run + "other");
  EXPECT_TRUE(holds(other,
                    "warning: my seed 1: not the robot of the calibration robot.yaml: "
                    "legs at 400 instead of 100 Hz"))
      << other.output;
}

TEST_F(Calibrate, ACalibrationWithoutEffectIsNoted) {
  scenario(testing::kMetreWalk);
  write("robot.yaml", with(kRobot, "used: true", "used: false"));
  const Outcome run =
      aims("run my.yaml --no-pictures --no-page --quiet --estimators leg --calibration robot.yaml");
  EXPECT_EQ(run.exit_code, 0) << run.output;
  EXPECT_TRUE(holds(run, "note: no quantity of the calibration robot.yaml is used")) << run.output;
}

TEST_F(Calibrate, RecordingsAndScenariosCannotBeMixed) {
  scenario(testing::kMetreWalk);
  write("a.bag", "no bag");
  const Outcome mixed = aims("calibrate a.bag my.yaml --robot-seed 3 --quiet -o robot.yaml");
  EXPECT_EQ(mixed.exit_code, 2) << mixed.output;
  EXPECT_TRUE(holds(mixed, "a.bag and my.yaml: a recording and a scenario cannot be mixed"))
      << mixed.output;
}

TEST_F(Calibrate, ARecordingCountsOnceAndATableIsOne) {
  write("a.bag", "no bag");
  const Outcome twice = aims("calibrate a.bag ./a.bag --quiet -o robot.yaml");
  EXPECT_EQ(twice.exit_code, 2) << twice.output;
  EXPECT_TRUE(holds(twice, "./a.bag: named twice")) << twice.output;
  write("walk.yaml", "file: walk.csv\ntime: t\ngyro: [a, b, c]\naccelerometer: [d, e, f]\n");
  const Outcome table = aims("calibrate walk.yaml --quiet -o robot.yaml");
  EXPECT_EQ(table.exit_code, 2) << table.output;
  EXPECT_TRUE(holds(table, "walk.csv: cannot be read")) << table.output;
}

TEST_F(Calibrate, SeveralSeedsNeedTheSeedOfTheOneRobot) {
  scenario(testing::kMetreWalk);
  const Outcome drawn = aims("calibrate my.yaml --seeds 1-2 --quiet -o robot.yaml");
  EXPECT_EQ(drawn.exit_code, 2) << drawn.output;
  EXPECT_TRUE(holds(drawn, "2 sequences have a robot drawn for each: expected --robot-seed"))
      << drawn.output;
}

TEST_F(Calibrate, ASecondTopicWithoutACommaIsNamed) {
  const Outcome refused = aims("calibrate a.bag --topics lidar=/a imu=/b --quiet -o robot.yaml");
  EXPECT_EQ(refused.exit_code, 2) << refused.output;
  EXPECT_TRUE(holds(refused, "imu=/b: no recording or scenario; --topics takes several"))
      << refused.output;
}

TEST_F(Calibrate, AFileThatIsNoneIsOneError) {
  scenario(testing::kMetreWalk);
  for (const char* command : {"run my.yaml", "suite my.yaml", "estimate my.bag"}) {
    const Outcome refused = aims(std::string(command) + " --calibration my.yaml --out out");
    EXPECT_EQ(refused.exit_code, 2) << refused.output;
    EXPECT_TRUE(holds(refused, "--calibration my.yaml:1")) << refused.output;
  }
  const Outcome legs = aims("run my.yaml --estimators leg --calibration none.yaml --out out");
  EXPECT_TRUE(holds(legs, "none.yaml")) << legs.output;
}

}  // namespace
}  // namespace aims
