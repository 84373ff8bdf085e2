// SPDX-License-Identifier: BSD-3-Clause
// Profiles of data sets and the files that they find, without a recording that is read.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "bench/estimate/dataset_profile.hpp"
#include "bench/estimate/dataset_sequences.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

class Profiles : public ::testing::Test {
 protected:
  fs::path folder() const { return folder_.path(); }

  void put(const std::string& name, const std::string& text = "") const {
    fs::create_directories((folder() / name).parent_path());
    std::ofstream(folder() / name) << text;
  }

  /// A profile of that text; `base` is beside it.
  Result<DatasetProfile> load(const std::string& text) const {
    put("base.yaml", "title: base\nrun: [lio]\ntruth: {files: [\"{sequence}.txt\"]}\n");
    put("mine.yaml", text);
    return load_dataset_profile(folder() / "mine.yaml", {});
  }

  std::string error_of(const std::string& text) const {
    const auto profile = load(text);
    return profile ? "no error" : profile.error().message;
  }

  static DatasetProfile published(const std::string& name) {
    auto profile =
        load_dataset_profile(fs::path(AIMS_SOURCE_DIR "/models/datasets") / (name + ".yaml"), {});
    EXPECT_TRUE(profile) << profile.error().message;
    return *profile;
  }

  /// The truth of each sequence of `data`, relative to it, or why there is none: "name: file".
  std::vector<std::string> truths(const DatasetProfile& profile,
                                  const std::string& data = "data") const {
    std::vector<std::string> lines;
    const auto sequences = dataset_sequences(profile, folder() / data);
    EXPECT_TRUE(sequences) << sequences.error().message;
    for (const DatasetSequence& each : *sequences) {
      const std::string file =
          each.truth.empty() ? "" : fs::path(each.truth).lexically_relative(folder() / data);
      lines.push_back(each.name + ": " + (file.empty() ? each.lack : file));
    }
    return lines;
  }

 private:
  TemporaryFolder folder_;
};

using Lines = std::vector<std::string>;

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(Profiles, AKeyWithoutEffectIsAnErrorWithItsPlace) {
  struct Case {
    const char* yaml;
    const char* key;
    const char* reason;
  };
  const Case cases[] = {
      {"truth: {files: [a.txt], lever_arm_frame: 0 0 0 0 0 0 1}", "truth.lever_arm_frame",
       "neither lever_arm nor lever_arm_files"},
      {"truth: {files: [a.txt], lever_arm: estimate, lever_arm_frame: 0 0 0 0 0 0 1}",
       "truth.lever_arm_frame", "estimated in the IMU frame"},
      {"truth: {lever_arm: 0 0 1}", "truth.lever_arm", "neither files nor topic"},
      {"truth: {extrinsic: 0 0 0 0 0 0 1}", "truth.extrinsic", "neither files nor topic nor"},
      {"truth: {files: [a.txt], end_pose_of: [a]}", "truth.end_pose_of", "end_pose is empty"},
      {"truth: {files: [a.txt], name_without: [_a]}", "truth.name_without", "no file has {name}"},
      {"published_source: a table", "published_source", "published is empty"},
      {"recording: {T_imu_lidar: {matrix: [1,0,0,0, 0,1,0,0, 0,0,1,0], translation: [1, 0, 0]}}",
       "recording.T_imu_lidar.translation", "matrix is given"},
      {"recording: {T_imu_base: {quaternion_xyzw: [0,0,0,1], rotation_rpy_deg: [0, 0, 9]}}",
       "recording.T_imu_base.rotation_rpy_deg", "quaternion_xyzw is given"},
      {"recording: {T_imu_lidar: {translation: [1, 0, 0], file_frames: [a, b]}}",
       "recording.T_imu_lidar.file_frames", "file names no calibration"}};
  for (const Case& each : cases) {
    const std::string error = error_of(std::string(each.yaml) + "\n");
    EXPECT_TRUE(holds(error, "mine.yaml:1:")) << error;
    EXPECT_TRUE(holds(error, std::string(each.key) + ": has no effect: ")) << error;
    EXPECT_TRUE(holds(error, each.reason)) << error;
  }
  EXPECT_EQ(error_of("base: base\ntruth: {files: [], end_pose: 0 0 0}\n"), "no error");
  EXPECT_EQ(error_of("truth: {files: [a.txt], lever_arm: 0 0 1, lever_arm_frame: 0 0 0 0 0 0 1}\n"),
            "no error");
}

TEST_F(Profiles, AScoreThatNoTrajectoryHasIsAnErrorWithTheNearOne) {
  for (const auto& [given, near] : {std::pair{"ate_se3", "ate_se3_m"},
                                    {"m_end", "m_end_m"},
                                    {"ate_yaw", "ate_yaw_m"},
                                    {"control_points.scor", "control_points.score"}}) {
    const std::string error = error_of(std::string("score: ") + given + "\n");
    EXPECT_TRUE(holds(error, std::string("no score '") + given + "'")) << error;
    EXPECT_TRUE(holds(error, std::string("did you mean '") + near + "'?")) << error;
    EXPECT_TRUE(holds(error, "mine.yaml:1:")) << error;
  }
  EXPECT_TRUE(holds(error_of("score: ate_sim3_m\n"), "no score")) << "scoring.sim3 is off";
  for (const char* right :
       {"ate_yaw_m", "m_end_m", "control_points.score2023", "rpe_10m.translation_m",
        "m_list_percent.all", "drift_m.end.vertical"}) {
    EXPECT_EQ(error_of(std::string("score: ") + right + "\n"), "no error");
  }
  EXPECT_EQ(load("score: m_end_m\n")->unit, "m");
  EXPECT_EQ(load("score: heading_error_mrad\n")->unit, "mrad");
  EXPECT_EQ(load("score: heading_error_mrad\nunit: deg\n")->unit, "deg");
}

TEST_F(Profiles, WhatIsNoPoseOrPointIsAnErrorBeforeTheRun) {
  EXPECT_TRUE(
      holds(error_of("truth: {files: [a.txt], extrinsic: 0 0 1}\n"), "--extrinsic '0 0 1'"));
  EXPECT_TRUE(holds(error_of("truth: {files: [a.txt], lever_arm: 1 2}\n"), "--lever-arm '1 2'"));
  EXPECT_TRUE(holds(error_of("truth: {end_pose: up}\n"), "--end-pose 'up'"));
  EXPECT_TRUE(holds(error_of("truth: {files: [a.txt], cases: [{of: [a], extrinsic: b}]}\n"),
                    "mine.yaml: truth.cases.0: --extrinsic 'b'"));
  EXPECT_TRUE(holds(error_of("truth: {files: [a.txt], cases: [{files: [b]}]}\n"),
                    "truth.cases.0.of: expected"));
  EXPECT_TRUE(holds(error_of("truth: {files: [a.txt], cases: [{of: [a]}]}\n"), "truth.cases.0: "));
}

TEST_F(Profiles, AMatrixThatIsNoRotationHasItsFileAndLine) {
  const std::string error = error_of(
      "title: mine\nrecording:\n  T_imu_lidar:\n    matrix: [2,0,0,0, 0,1,0,0, 0,0,1,0]\n");
  EXPECT_TRUE(holds(error, "mine.yaml:4:")) << error;
  EXPECT_TRUE(holds(error, "recording.T_imu_lidar.matrix: expected a rotation matrix")) << error;
  put("estimate.yaml", "recording:\n  T_imu_base: {quaternion_xyzw: [1, 1, 1, 1]}\n");
  const auto config = load_estimate_config(folder() / "estimate.yaml", {});
  ASSERT_FALSE(config);
  EXPECT_TRUE(holds(config.error().message, "estimate.yaml:2:")) << config.error().message;
  const std::vector<std::string> set = {
      "recording.T_imu_lidar.rotation_matrix=[1,0,0,0,1,0,0,0,2]"};
  const auto overridden = load_estimate_config({}, set);
  ASSERT_FALSE(overridden);
  EXPECT_TRUE(holds(overridden.error().message, "--set recording.T_imu_lidar.rotation_matrix"))
      << overridden.error().message;
}

TEST_F(Profiles, ATruthOfAnotherSequenceIsNotTaken) {
  const auto profile = load("truth: {files: [\"{sequence}*.csv\"]}\n");
  ASSERT_TRUE(profile) << profile.error().message;
  put("data/day.bag");
  put("data/day_2.bag");
  put("data/day_2_leica.csv");
  const std::string none = "day: no truth: looked for day*.csv";
  EXPECT_EQ(truths(*profile), (Lines{none, "day_2: day_2_leica.csv"}));
  put("data/day_leica.csv");
  EXPECT_EQ(truths(*profile), (Lines{"day: day_leica.csv", "day_2: day_2_leica.csv"}));
  fs::remove(folder() / "data/day_2.bag");
  fs::remove(folder() / "data/day_leica.csv");
  EXPECT_EQ(truths(*profile), (Lines{none})) << "its recording may lie elsewhere";
  put("data/daylight.csv");
  EXPECT_EQ(truths(*profile), (Lines{none}));
  put("data/day_2021-07-01.csv");
  EXPECT_EQ(truths(*profile), (Lines{"day: day_2021-07-01.csv"})) << "a date";
}

TEST_F(Profiles, ATruthOfAnotherSequenceIsNotTakenByNamesWithoutTheDate) {
  const auto profile = load("truth: {files: [\"*{name}*.csv\"]}\n");
  ASSERT_TRUE(profile) << profile.error().message;
  put("data/2021-07-01-10-37-38-quad.bag");
  put("data/2021-07-01-10-40-50-quad-hard.bag");
  put("data/gt-quad-hard.csv");
  const Lines found = truths(*profile);
  EXPECT_TRUE(holds(found[0], "2021-07-01-10-37-38-quad: no truth")) << found[0];
  EXPECT_EQ(found[1], "2021-07-01-10-40-50-quad-hard: gt-quad-hard.csv");
}

TEST_F(Profiles, ATruthOnATopicIsNamedByIt) {
  const auto profile = load("truth: {topic: /boxi/prism/position}\n");
  ASSERT_TRUE(profile) << profile.error().message;
  DatasetSequence sequence{.name = "day",
                           .recording = "data/day.bag",
                           .truth = "data/day.bag:/boxi/prism/position"};
  EXPECT_EQ(truth_text(*profile, sequence), "topic /boxi/prism/position of the recording");
  sequence.truth = "data/day_leica.csv";
  EXPECT_EQ(truth_text(*profile, sequence), "day_leica.csv");
}

TEST_F(Profiles, SeveralTruthsOfOnePatternAreNamedAndNoneIsTaken) {
  const auto profile = load("truth: {files: [\"{sequence}*.csv\"]}\n");
  put("data/day.bag");
  put("data/day_leica.csv");
  put("data/day_vicon.csv");
  const Lines found = truths(*profile);
  EXPECT_TRUE(holds(found[0], "day_leica.csv, day_vicon.csv are all named as day*.csv"))
      << found[0];
}

TEST_F(Profiles, ANameThatIsOfNoSequenceIsLookedForInItsOwnFolder) {
  const auto profile = load("truth: {files: [poses.tum]}\n");
  put("data/day.bag");
  put("data/night/a.bag");
  put("data/night/poses.tum");
  put("data/poses.tum");
  const Lines found = truths(*profile);
  EXPECT_TRUE(
      holds(found[0], "poses.tum, which without {sequence} is looked for in its own folder"))
      << found[0];
  EXPECT_EQ(found[1], "night: night/poses.tum");
}

TEST_F(Profiles, PublishedNamesFindTheirTruths) {
  put("data/2023-08-08-17-12-37-tunnel_s.bag");
  put("data/2023-08-08-17-50-31-tunnel_d.bag");
  put("data/gt-tunnel_s.csv");
  EXPECT_EQ(truths(published("enwide"))[0], "2023-08-08-17-12-37-tunnel_s: gt-tunnel_s.csv");
  EXPECT_TRUE(holds(truths(published("enwide"))[1], "gt-tunnel_d.csv"));
  for (const char* each : {"Shield_tunnel1", "Shield_tunnel10", "Tunneling_tunnel2"}) {
    put(std::string("geode/") + each + "_gamma.bag");
    put(std::string("geode/") + each + ".txt");
  }
  put("geode/Inland_Waterways_Short_Gamma.bag");
  put("geode/Inland_Waterways_Short_gt.txt");
  EXPECT_EQ(truths(published("geode_gamma"), "geode"),
            (Lines{"Inland_Waterways_Short_Gamma: Inland_Waterways_Short_gt.txt",
                   "Shield_tunnel10_gamma: Shield_tunnel10.txt",
                   "Shield_tunnel1_gamma: Shield_tunnel1.txt",
                   "Tunneling_tunnel2_gamma: Tunneling_tunnel2.txt"}));
  put("hilti/exp04_construction_upper_level.bag");
  put("hilti/exp_06_construction_upper_level_hard_2022-03-03-12-08-37.bag");
  const std::string old = "exp_04_construction_upper_level_easy_2_2022-03-03-11-48-59_imu.txt";
  const std::string six = "exp_06_construction_upper_level_hard_2022-03-03-12-08-37";
  put("hilti/groundtruth_2022/" + old);
  put("hilti/groundtruth_2022/" + six + "_imu.txt");
  EXPECT_EQ(truths(published("hilti22_imu"), "hilti"),
            (Lines{"exp04_construction_upper_level: groundtruth_2022/" + old,
                   six + ": groundtruth_2022/" + six + "_imu.txt"}));
  EXPECT_TRUE(holds(truths(published("hilti22"), "hilti")[0], "no truth")) << "another body";
}

TEST_F(Profiles, BagsInAFolderOfTheSequenceAreOfThatSequence) {
  const DatasetProfile profile = published("newer_college20");
  put("data/01_short_experiment/rosbag/rooster_0.bag");
  put("data/01_short_experiment/rosbag/rooster_1.bag");
  put("data/01_short_experiment/ground_truth/registered_poses.csv");
  put("data/02_long_experiment/rosbag/rooster_0.bag");
  const std::string truth = "01_short_experiment/ground_truth/registered_poses.csv";
  EXPECT_EQ(truths(profile)[0], "01_short_experiment: " + truth);
  EXPECT_TRUE(holds(truths(profile)[1], "02_long_experiment: no truth"));
  EXPECT_EQ(truths(profile, "data/01_short_experiment"),
            (Lines{"01_short_experiment: ground_truth/registered_poses.csv"}));
  EXPECT_EQ(truths(profile, "data/01_short_experiment/"),
            (Lines{"01_short_experiment: ground_truth/registered_poses.csv"}));
}

TEST_F(Profiles, MeasuredPointsThatLackAreNoScore) {
  put("data/site2_robot_1.bag");
  put("data/groundtruth_2023/site2_robot_1.txt");
  const auto sequences = dataset_sequences(published("hilti23_robot"), folder() / "data");
  EXPECT_TRUE(holds(sequences->front().lack, "no measured points")) << sequences->front().lack;
}

TEST_F(Profiles, NotesSayHowEstimatesMeetTheTruth) {
  const auto notes = [](const std::string& profile, const std::string& sequence) {
    const std::vector<std::string> lines =
        scoring_notes(published(profile), {.name = sequence, .recording = "", .truth = "x/t.txt"});
    std::string text;
    for (const std::string& each : lines) text += each + "\n";
    return text;
  };
  EXPECT_TRUE(holds(notes("geode", "Offroad1_alpha"), "truth: t.txt\n"));
  EXPECT_TRUE(holds(notes("geode", "Offroad1_alpha"), "alpha2GT_gnss.py"));
  EXPECT_FALSE(holds(notes("geode", "stairs_alpha"), "GT_"));
  EXPECT_TRUE(holds(notes("geode_gamma", "Shield_tunnel1_gamma"), "gamma2GT_leica.py"));
  EXPECT_TRUE(holds(notes("hilti22", "exp07"), "lever arm: 0.059 -0.00855 0.1964"));
  EXPECT_FALSE(holds(notes("hilti22_imu", "exp04"), "lever arm: "));
  EXPECT_TRUE(holds(notes("m3dgr", "Dynamic01"), "taken to be of the IMU"));
  EXPECT_TRUE(holds(notes("newer_college", "quad"), "IMU in the body of the truth: -0.012720"));
}

TEST_F(Profiles, LegsOfLegKiloAreNotThoseOfUnitree) {
  EXPECT_EQ(published("leg_kilo").read.recording.topics.leg_odometry, "none");
  EXPECT_TRUE(published("diter_plusplus").read.recording.T_imu_base.is_given());
}

}  // namespace
}  // namespace aims
