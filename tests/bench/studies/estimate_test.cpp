// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/estimate.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/jobs/results.hpp"
#include "bench/run/estimate_summary.hpp"
#include "bench/run/record.hpp"
#include "bench/run/trajectory_summary.hpp"
#include "bench/run/validity.hpp"
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
    EXPECT_EQ(trajectory_score_table(*result.scores).rows.at(0).back(), "interrupted");
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

}  // namespace
}  // namespace aims
