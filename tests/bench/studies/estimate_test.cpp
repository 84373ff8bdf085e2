// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/estimate.hpp"

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>

#include "bench/estimate/estimate_summary.hpp"
#include "bench/run/record.hpp"
#include "bench/scoring/result_files.hpp"
#include "bench/scoring/trajectory_summary.hpp"
#include "bench/scoring/validity.hpp"
#include "core/files/atomic_file.hpp"
#include "recordings/messages/message_types.hpp"
#include "tests/bench/short_walk.hpp"
#include "tests/recordings/stream/robot_recording.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

/// Estimates the bag until `end_s` of it.
EstimateResult estimate_until(const std::filesystem::path& bag, double end_s) {
  EstimateConfig config;
  config.run = {"leg"};
  auto result = estimate(
      config, {bag}, [end_s](const Progress& progress) { return progress.simulated_s < end_s; });
  EXPECT_TRUE(result) << result.error().message;
  return std::move(*result);
}

TEST(Estimate, ThatIsInterruptedIsLabelledSoAndEntersNoAverage) {
  const TemporaryFolder folder;
  RecordOptions options;
  options.bag = folder.path() / "walk.bag";
  ASSERT_TRUE(record(testing::short_walk(), options, [](const Progress&) { return true; }));
  for (const double end_s : {0.5, 3.0}) {  // while it stands, and while it walks
    const EstimateResult result = estimate_until(options.bag, end_s);
    EXPECT_FALSE(result.complete);
    ASSERT_TRUE(result.scores);
    EXPECT_FALSE(result.scores->estimates.at(0).scores.success);
    EXPECT_EQ(result.scores->estimates.at(0).scores.failure_reason, FailureReason::kInterrupted);
    const auto row = trajectory_score_table(*result.scores).rows.at(0);
    EXPECT_EQ(row.at(row.size() - 2), "interrupted");
    ASSERT_TRUE(write_estimate({}, result, folder.path()));
    const auto record = read_record(folder.path() / "scores.json");
    ASSERT_TRUE(record);
    EXPECT_EQ(record->scores["complete"], false);
    EXPECT_EQ(record->scores["estimators"]["leg"]["diverged_reason"], "interrupted");
    EXPECT_TRUE(record->scores["estimators"]["leg"]["diverged_at_s"].is_null());
    EXPECT_FALSE(is_valid_run(*record));
  }
  EXPECT_TRUE(estimate_until(options.bag, 1e9).scores->estimates.at(0).scores.success);
}

TEST(Estimate, WithoutATruthScansToShowArePlacedByAnEstimate) {
  const TemporaryFolder folder;
  RecordOptions options;
  options.bag = folder.path() / "walk.bag";
  ASSERT_TRUE(record(testing::short_walk(), options, [](const Progress&) { return true; }));
  EstimateConfig config;
  config.run = {"lio"};
  const auto scans_of = [&] {
    const auto result = estimate(config, {options.bag}, [](const Progress&) { return true; });
    EXPECT_TRUE(result) << result.error().message;
    return result->scans;
  };
  const auto truly = scans_of();
  config.recording.topics.truth = "none";
  const auto estimated = scans_of();
  ASSERT_GT(estimated.size(), 1U);
  std::size_t compared = 0;
  for (const ShownScan& scan : estimated) {
    const auto same = std::ranges::find(truly, scan.stamp, &ShownScan::stamp);
    if (same == truly.end() || same->shown.size() != scan.shown.size()) continue;
    float sum = 0.0F;
    for (std::size_t i = 0; i < scan.shown.size(); ++i) {
      sum += (scan.shown[i].p_body - same->shown[i].p_body).norm();
    }
    EXPECT_LT(sum / static_cast<float>(scan.shown.size()), 0.02F) << to_seconds(scan.stamp);
    ++compared;
  }
  EXPECT_GE(compared, estimated.size() - 1);
}

/// Whether the notes on a bag of an IMU, of clouds with times of the points or without, and of leg
/// odometry without joints state that the estimator lacks `what`.
bool lacks(const std::string& estimator, const std::string& what, bool timed = true) {
  const TemporaryFolder folder;
  test::RobotRecording robot(folder.path() / "robot.bag");
  robot.add_imu(test::kStart, 50);
  for (int k = 0; k < 8; ++k) {
    const Time stamp = test::kStart + k * 100 * kMillisecond;
    const float late = timed ? 0.05F : 0.0F;
    robot.add_cloud(test::RawCloud::of(stamp, {{1, 2, 3, 0}, {2, 1, 3, late}}), stamp);
    robot.add("/odom", odometry_type(), stamp, odometry_message({0, stamp, "odom"}, "base", {}));
  }
  robot.close();
  EstimateConfig config;
  config.run = {estimator};
  const auto result =
      estimate(config, {folder.path() / "robot.bag"}, [](const Progress&) { return true; });
  EXPECT_TRUE(result) << result.error().message;
  const std::string label = estimator.substr(0, estimator.find('='));
  return std::ranges::count(result->setup.notes,
                            label + " needs " + what + ", which the recording lacks") == 1;
}

TEST(Estimate, NotesWhatTheRecordingLacksForAnEstimator) {
  EXPECT_TRUE(lacks("fast_lio2", "the time of each point", false));
  EXPECT_FALSE(lacks("fast_lio2", "the time of each point"));
  EXPECT_FALSE(lacks("lio", "the time of each point", false));
  EXPECT_TRUE(lacks("kilo=leg_kilo+legs.feet=contacts", "joints and contacts"));
  EXPECT_FALSE(lacks("leg_kilo", "joints and contacts"));
}

TEST(Estimate, ATruthOfOneAttitudeIsOfPositions) {
  for (const bool turns : {false, true}) {
    const TemporaryFolder folder;
    test::RobotRecording robot(folder.path() / "robot.bag");
    robot.add_imu(test::kStart, 400);
    for (int k = 0; k < 40; ++k) {
      const Time stamp = test::kStart + k * 50 * kMillisecond;
      const Pose pose{yaw_rotation(0.02 * k), {0.05 * k, 0.0, 0.0}};
      const Pose measured{turns ? pose.rotation : Eigen::Quaterniond::Identity(),
                          k == 20 ? Eigen::Vector3d(0, 0, 0) : pose.translation};
      robot.add("/odom", odometry_type(), stamp,
                odometry_message({0, stamp, "odom"}, "imu", {pose, {}, {}}));
      robot.add("/ground_truth/imu", odometry_type(), stamp,
                odometry_message({0, stamp, "world"}, "imu", {measured, {}, {}}));
    }
    robot.close();
    EstimateConfig config;
    config.run = {"leg"};
    config.recording.topics.lidar = "none";
    const auto result =
        estimate(config, {folder.path() / "robot.bag"}, [](const Progress&) { return true; });
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_TRUE(result->scores);
    EXPECT_EQ(result->scores->scoring.truth, turns ? TruthContent::kPose : TruthContent::kPosition);
    EXPECT_EQ(std::ranges::count(result->setup.warnings, "truth of positions alone",
                                 &ReadingWarning::reason),
              turns ? 0 : 1);
    EXPECT_EQ(result->scores->truth.trajectory.size(), turns ? 40U : 39U) << "one is unset";
  }
}

std::string content(const std::filesystem::path& file) {
  const auto text = read_file(file);
  EXPECT_TRUE(text) << text.error().message;
  return text.value_or("");
}

TEST(Estimate, IntoAFolderComesToTheSameFilesAsInMemory) {
  const TemporaryFolder folder;
  RecordOptions recording;
  recording.bag = folder.path() / "walk.bag";
  const auto go_on = [](const Progress&) { return true; };
  ASSERT_TRUE(record(testing::short_walk(), recording, go_on));
  EstimateConfig config;
  config.run = {"aims", "leg"};
  const auto outputs = [&](const std::string& name, bool streamed) {
    const auto out = folder.path() / name;
    std::filesystem::create_directory(out);
    EstimateOptions options = {recording.bag};
    if (streamed) options.folder = out;
    const auto result = estimate(config, options, go_on);
    EXPECT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->truth.empty(), streamed);
    EXPECT_EQ(result->estimators.at(0).result.trajectory.empty(), streamed);
    EXPECT_TRUE(write_estimate(config, *result, out));
    Json scores = estimate_record(*result).scores;
    for (const char* estimator : {"aims", "leg"}) {
      scores["estimators"][estimator].erase("time_per_scan_ms");
      scores["estimators"][estimator].erase("cpu_per_scan_ms");
    }
    return scores;
  };
  EXPECT_EQ(outputs("whole", false), outputs("parts", true));
  for (const char* file : {"aims.tum", "aims.health.csv", "aims.map.ply", "leg.tum",
                           "leg.diagnostics.csv", "leg.health.csv", "truth.tum"}) {
    EXPECT_EQ(content(folder.path() / "whole" / file), content(folder.path() / "parts" / file))
        << file;
  }
}

/// Ten minutes of an IMU, leg odometry and a truth at 100 Hz.
void write_long_recording(const std::filesystem::path& bag) {
  test::RobotRecording robot(bag);
  robot.add_transforms(test::kMounted);
  robot.add_cloud(test::RawCloud::of(test::kStart, {{1, 2, 3, 0}}), test::kStart);
  robot.add_imu(test::kStart, 30'000);
  for (int k = 0; k < 60'000; ++k) {
    const Time stamp = test::kStart + k * 10 * kMillisecond;
    const auto message = odometry_message({0, stamp, "odom"}, "base", {});
    if (k % 5 == 0) robot.add("/odom", odometry_type(), stamp, message);
    robot.add("/truth", odometry_type(), stamp, message);
  }
  robot.close();
}

/// How much more heap is in use [bytes] near the end of the recording than after a fifth of it.
long long growth(const std::filesystem::path& bag, const std::filesystem::path& folder) {
  EstimateConfig config;
  config.run = {"leg"};
  config.recording.topics.leg_odometry = "/odom";
  config.recording.topics.truth = "/truth";
  const auto in_use = [] {
    const struct mallinfo2 heap = mallinfo2();
    return static_cast<long long>(heap.uordblks + heap.hblkhd);
  };
  long long begin = 0;
  long long end = 0;
  EstimateOptions options = {bag};
  options.folder = folder;
  const auto result = estimate(config, options, [&](const Progress& progress) {
    if (progress.simulated_s < 120.0) begin = in_use();
    if (progress.simulated_s < 590.0) end = in_use();
    return true;
  });
  EXPECT_TRUE(result) << result.error().message;
  EXPECT_GT(result->estimators.at(0).totals.poses, 2000U);
  return end - begin;
}

TEST(Estimate, IntoAFolderNeedsNoMemoryForTheTruth) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer's heap is not that of the C library";
#endif
  const TemporaryFolder folder;
  const auto bag = folder.path() / "long.bag";
  write_long_recording(bag);
  const long long truth = 47'000 * static_cast<long long>(sizeof(StampedPose));
  EXPECT_GT(growth(bag, {}), truth);
  EXPECT_LT(growth(bag, folder.path()), truth / 4);
}

}  // namespace
}  // namespace aims
