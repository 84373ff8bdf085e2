// SPDX-License-Identifier: BSD-3-Clause
// `aims simulate`, `estimate`, `info` and `check`, run as a user would.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "core/files/atomic_file.hpp"
#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::Outcome;

/// Two metres of a corridor, with faults on every link.
/// Clocks are right: a reader finds the period of scans from their stamps to a nanosecond, and
/// interpolates the truth between the poses of the recording, 10 ms apart.
const std::string kShortWalk =
    "scene: {corridor: {length: 10}}\n"
    "route: {stand_before: 2.5, points: [{name: a, x: 0, y: 0}, {name: b, x: 2, y: 0}]}\n"
    "lidar: {columns: 600}\n"
    "links:\n"
    "  leg_odometry: {loss: 0.1, jitter: 0.01, duplicate_probability: 0.01, clock_drift_sigma: 0}\n"
    "  imu: {reorder_probability: 0.02, stamp_jitter: 0.0005}\n"
    "  lidar: {delay: 0.02, clock_offset_sigma: 0, clock_drift_sigma: 0}\n";

class Recordings : public testing::CommandLine {
 protected:
  std::string text_of(const std::string& file) const {
    return read_file(folder_.path() / file).value();
  }

  /// Refused with exit code 2 and one line that holds all of `expected`.
  void expect_refused(const std::string& arguments,
                      std::initializer_list<std::string> expected) const {
    const Outcome outcome = aims(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    for (const std::string& each : expected) {
      EXPECT_NE(outcome.output.find(each), std::string::npos) << each << "\n" << outcome.output;
    }
    EXPECT_FALSE(fs::exists(folder_.path() / "out"));
  }

  /// walk.bag and what the command said.
  Outcome simulate(const std::string& options = "") const {
    return aims("simulate " + scenario(kShortWalk) + " --quiet --out walk.bag " + options);
  }
};

TEST_F(Recordings, EstimatingABagGivesTheBytesOfTheRun) {
  const std::string estimators =
      " --estimators aims,aims_d,tfs,tfs_clean,lio,leg --no-pictures --quiet ";
  const Outcome run = aims("run " + scenario(kShortWalk) + estimators + "--out direct");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  for (const char* compression : {"none", "lz4"}) {
    const Outcome made = simulate(std::string("--overwrite --compression ") + compression);
    ASSERT_EQ(made.exit_code, 0) << made.output;
    const Outcome estimate = aims("estimate walk.bag" + estimators + "--overwrite --out replayed");
    ASSERT_EQ(estimate.exit_code, 0) << estimate.output;
    for (const char* name : {"aims", "aims_d", "tfs", "tfs_clean", "lio", "leg"}) {
      const std::string file = std::string("/") + name + ".tum";
      EXPECT_EQ(text_of("direct" + file), text_of("replayed" + file)) << name << compression;
    }
    EXPECT_EQ(text_of("direct/truth.tum"), text_of("replayed/truth.tum"));
  }
}

TEST_F(Recordings, EveryFormatGivesTheSameTrajectories) {
  ASSERT_EQ(simulate().exit_code, 0);
  const std::string estimators = " --estimators aims_d,leg --no-pictures --no-page --quiet --out ";
  ASSERT_EQ(aims("estimate walk.bag" + estimators + "bag").exit_code, 0);
  const Outcome made =
      aims("simulate " + scenario(kShortWalk) + " --quiet --out walk.mcap --compression zstd");
  ASSERT_EQ(made.exit_code, 0) << made.output;
  ASSERT_EQ(aims("convert walk.bag --quiet --out copy.mcap").exit_code, 0);
  for (const char* file : {"walk.mcap", "copy.mcap"}) {
    const std::string out = std::string("of-") + file;
    const Outcome estimate = aims(std::string("estimate ") + file + estimators + out);
    ASSERT_EQ(estimate.exit_code, 0) << estimate.output;
    for (const char* name : {"aims_d.tum", "leg.tum", "truth.tum"}) {
      EXPECT_EQ(text_of("bag/" + std::string(name)), text_of(out + "/" + name)) << file << name;
    }
    const Outcome score = aims(std::string("score --truth ") + file + ":/ground_truth/imu" +
                               " --estimate " + out + "/aims_d.tum --no-pictures --out s-" + file);
    EXPECT_EQ(score.exit_code, 0) << score.output;
    EXPECT_EQ(aims(std::string("check ") + file + " --system aims").exit_code, 0) << file;
  }
}

TEST_F(Recordings, TopicsAreDroppedAndWhatIsLeftIsCheckedAndEstimated) {
  ASSERT_EQ(simulate().exit_code, 0);
  expect_refused("convert walk.bag --drop /lidar/point --out legs.bag",
                 {"no topic '/lidar/point' to leave out", "did you mean '/lidar/points'?"});
  const Outcome made = aims("convert walk.bag --drop /lidar/points,/foot_contacts --out legs.bag");
  ASSERT_EQ(made.exit_code, 0) << made.output;
  const Outcome whole = aims("info walk.bag");
  const Outcome left = aims("info legs.bag");
  EXPECT_TRUE(holds(whole, "/lidar/points ")) << whole.output;
  EXPECT_FALSE(holds(left, "/lidar/points ")) << left.output;
  EXPECT_TRUE(holds(left, "/imu/data ")) << left.output;
  const Outcome check = aims("check legs.bag --system aims_d,lio");
  EXPECT_TRUE(holds(check,
                    "aims_d: poor: 3-D LiDAR clouds: found none; "
                    "--set recording.topics.lidar=none estimates"))
      << check.output;
  EXPECT_TRUE(holds(check, "lio: MISSING: 3-D LiDAR clouds")) << check.output;
  const std::string setting = " --set recording.topics.lidar=none ";
  EXPECT_EQ(aims("check legs.bag --system aims_d" + setting).exit_code, 0);
  const Outcome estimate = aims(
      "estimate legs.bag --estimators aims_d --no-pictures --no-page --quiet --out legs" + setting);
  EXPECT_NE(estimate.exit_code, 2) << estimate.output;
  EXPECT_TRUE(fs::exists(folder_.path() / "legs" / "aims_d.tum")) << estimate.output;
}

TEST_F(Recordings, ABagThatHoldsTheTruthIsScoredAsTheRunIs) {
  const Outcome run = aims("run " + scenario(kShortWalk) +
                           " --estimators aims_d --no-pictures --quiet --out direct");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  ASSERT_EQ(simulate().exit_code, 0);
  const Outcome estimate = aims("estimate walk.bag --quiet --out replayed");
  ASSERT_EQ(estimate.exit_code, 0) << estimate.output;
  EXPECT_NE(estimate.output.find("M_list(a-b) %"), std::string::npos) << estimate.output;
  const std::string scores = text_of("replayed/scores.json");
  const std::string direct = text_of("direct/scores.json");
  for (const char* key : {"\"m_end_m\": ", "\"ate_m\": "}) {
    const std::size_t at = direct.find(key);
    const std::string line = direct.substr(at, direct.find('\n', at) - at);
    EXPECT_NE(scores.find(line.substr(0, 24)), std::string::npos) << line;
  }
  for (const char* picture : {"aims_d-map-top.png", "degeneracy.png", "trajectories.png"}) {
    EXPECT_TRUE(fs::exists(folder_.path() / "replayed" / picture)) << picture;
  }
}

TEST_F(Recordings, AKilledSimulationLeavesABagThatOpens) {
  int with_messages = 0;
  for (const char* after : {"0.4", "0.7", "1.1", "1.9"}) {
    shell(std::string("timeout -s KILL ") + after + " '" AIMS_COMMAND "' simulate '" +
          AIMS_SCENARIOS + "/paper/corridor.yaml' --quiet --overwrite --out killed.bag");
    EXPECT_FALSE(fs::exists(folder_.path() / "killed.bag")) << "it is not whole";
    if (!fs::exists(folder_.path() / "killed.bag.partial")) continue;
    const Outcome info = aims("info killed.bag.partial");
    EXPECT_EQ(info.exit_code, 0) << after << info.output;
    EXPECT_EQ(info.output.find("never closed"), std::string::npos) << info.output;
    with_messages += info.output.find("/lidar/points ") != std::string::npos ? 1 : 0;
  }
  EXPECT_GT(with_messages, 0);
}

TEST_F(Recordings, InfoShowsTopicsFieldsTransformsAndImu) {
  ASSERT_EQ(simulate("--fast-imu 200").exit_code, 0);
  const Outcome info = aims("info walk.bag");
  EXPECT_EQ(info.exit_code, 0) << info.output;
  for (const char* part :
       {"/imu/data_fast", "sensor_msgs/PointCloud2", "time float32@18", "ring uint16@16",
        "imu -> lidar: [0.0300, 0.0000, 0.1600]", "without motion", "force in m/s^2"}) {
    EXPECT_NE(info.output.find(part), std::string::npos) << part << "\n" << info.output;
  }
}

TEST_F(Recordings, CheckNamesWhatASystemMisses) {
  ASSERT_EQ(simulate().exit_code, 0);
  const Outcome all = aims("check walk.bag");
  EXPECT_EQ(all.exit_code, 0) << all.output;
  EXPECT_NE(all.output.find("LIO-SAM: poor: IMU of 200 Hz"), std::string::npos) << all.output;
  EXPECT_EQ(aims("check walk.bag --system LIO-SAM,FAST-LIO2").exit_code, 0)
      << "poorly, but they run";
  const Outcome unitree = aims("check walk.bag --system Leg-KILO");
  EXPECT_EQ(unitree.exit_code, 1);
  EXPECT_NE(unitree.output.find("unitree_legged_msgs/HighState"), std::string::npos)
      << unitree.output;
  const Outcome unknown = aims("check walk.bag --system SLAM9000");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.output.find("FAST-LIO2"), std::string::npos) << unknown.output;
}

TEST_F(Recordings, CheckJudgesEachTopicThoughAnotherIsAmbiguous) {
  ASSERT_EQ(simulate("--fast-imu 200").exit_code, 0);
  std::string bytes = text_of("walk.bag");
  for (std::string_view name : {"/imu/data", "/leg_odometry"}) {  // no longer the default names
    for (std::size_t at = bytes.find(name); at != std::string::npos; at = bytes.find(name, at)) {
      bytes[at + 3] = 'x';
    }
  }
  write("two.bag", bytes);
  const Outcome check = aims("check two.bag --system aims");
  EXPECT_EQ(check.exit_code, 1) << check.output;
  EXPECT_NE(check.output.find("aims: MISSING: readable by aims: two.bag: several topics are "
                              "sensor_msgs/Imu: /imx/data, /imx/data_fast"),
            std::string::npos)
      << check.output;
  EXPECT_EQ(check.output.find("leg odometry"), std::string::npos) << check.output;
  const Outcome chosen = aims("check two.bag --system aims --set recording.topics.imu=/imx/data");
  EXPECT_EQ(chosen.exit_code, 0) << chosen.output;
}

TEST_F(Recordings, CheckTakesTheExtrinsicsOfTheConfiguration) {
  ASSERT_EQ(simulate().exit_code, 0);
  std::string bytes = text_of("walk.bag");
  for (std::size_t at = bytes.find("/tf_static"); at != std::string::npos;) {
    bytes[at + 1] = 'x';
    at = bytes.find("/tf_static");
  }
  write("bare.bag", bytes);
  EXPECT_NE(aims("check bare.bag --system aims").output.find("no tf_static"), std::string::npos);
  write("mount.yaml",
        "recording: {T_imu_lidar: {override_tf: true, translation: [0.03, 0, 0.16]}}\n");
  const Outcome check = aims("check bare.bag --system aims --config mount.yaml");
  EXPECT_EQ(check.exit_code, 0) << check.output;
  EXPECT_EQ(check.output.find("tf_static"), std::string::npos) << check.output;
  EXPECT_EQ(aims("info bare.bag --config mount.yaml").output.find("T_imu_lidar"),
            std::string::npos);
}

TEST_F(Recordings, BadInputIsRefusedWithFileAndOffset) {
  std::ofstream(folder_.path() / "text.bag") << "these are words, not a bag\n";
  expect_refused("estimate text.bag", {"text.bag", "byte 0"});
  expect_refused("info text.bag", {"text.bag", "byte 0"});
  expect_refused("check text.bag", {"text.bag"});
  expect_refused("estimate absent.bag", {"absent.bag"});
  ASSERT_EQ(simulate().exit_code, 0);
  fs::copy_file(folder_.path() / "walk.bag", folder_.path() / "cut.bag");
  fs::resize_file(folder_.path() / "cut.bag", fs::file_size(folder_.path() / "walk.bag") / 2);
  expect_refused("estimate cut.bag", {"cut.bag", "at byte", "--recover"});
  expect_refused("estimate walk.bag --topics lidar=/velodyne", {"/velodyne", "/lidar/points"});
  expect_refused("estimate walk.bag --topics lidars=/lidar/points", {"lidars", "lidar"});
  expect_refused("estimate walk.bag --topics /lidar/points", {"--topics", "SENSOR=TOPIC"});
  expect_refused("estimate walk.bag --estimators ames", {"ames", "aims"});
  expect_refused("estimate walk.bag --set estimators.aims.degeneracy.etta=3", {"etta", "eta"});
  expect_refused("simulate my.yaml --out walk.bag", {"walk.bag"});
}

TEST_F(Recordings, WhatIsWholeOfACutBagIsEstimatedWhenAskedFor) {
  ASSERT_EQ(simulate().exit_code, 0);
  fs::resize_file(folder_.path() / "walk.bag", fs::file_size(folder_.path() / "walk.bag") * 2 / 3);
  const Outcome outcome = aims("estimate walk.bag --recover --no-pictures --quiet --out replayed");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_GT(text_of("replayed/aims_d.tum").size(), 1000U);
}

}  // namespace
}  // namespace aims
