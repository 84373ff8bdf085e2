// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bench/scoring/result_files.hpp"
#include "bench/scoring/tables.hpp"
#include "core/files/atomic_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// An estimator with series of its own; the second scan has neither covariance nor "spread".
EstimatorOutcome outcome() {
  EstimatorOutcome outcome;
  outcome.name = "other";
  outcome.result.trajectory = {{kSecond, Pose()}, {2 * kSecond, Pose()}};
  PoseCovariance covariance;
  covariance.position << 4.0, 1.0, 0.0, 1.0, 5.0, 2.0, 0.0, 2.0, 6.0;
  covariance.rotation = 0.5 * Eigen::Matrix3d::Identity();
  outcome.result.diagnostics.series = {{"spread", "m", "of particles"}, {"count", "-", "of them"}};
  outcome.result.diagnostics.scans = {{kSecond, covariance, {0.1, 30.0}},
                                      {2 * kSecond, std::nullopt, {kNone, 40.0}}};
  outcome.scan_times.wall_ms = {1.5, 2.5};
  return outcome;
}

TEST(DiagnosticsTable, HasTheSeriesOfTheEstimatorAndEmptyCellsWhereNothingIsComputed) {
  const EstimatorOutcome written = outcome();
  EXPECT_EQ(diagnostics_table(rows_of(written)).text(),
            "stamp_s,spread,count,"
            "position_covariance_xx,position_covariance_xy,position_covariance_xz,"
            "position_covariance_yy,position_covariance_yz,position_covariance_zz,"
            "rotation_covariance_xx,rotation_covariance_xy,rotation_covariance_xz,"
            "rotation_covariance_yy,rotation_covariance_yz,rotation_covariance_zz,time_ms\n"
            "1,0.1,30,4,1,0,5,2,6,0.5,0,0,0.5,0,0.5,1.5\n"
            "2,,40,,,,,,,,,,,,,2.5\n");
}

TEST(DiagnosticsTable, ReadsBackAsItWasWritten) {
  const TemporaryFolder folder;
  const EstimatorOutcome written = outcome();
  ASSERT_TRUE(write_estimator(written, folder.path(), "other"));
  const auto read = read_estimator(folder.path(), "other");
  ASSERT_TRUE(read) << read.error().message;
  const Diagnostics& diagnostics = read->result.diagnostics;
  ASSERT_EQ(diagnostics.series.size(), 2U);
  EXPECT_EQ(diagnostics.series[0].name, "spread");
  ASSERT_EQ(diagnostics.scans.size(), 2U);
  EXPECT_EQ(diagnostics.scans[1].stamp, 2 * kSecond);
  EXPECT_EQ(diagnostics.value(0, "spread"), 0.1);
  EXPECT_TRUE(std::isnan(diagnostics.value(1, "spread")));
  EXPECT_TRUE(diagnostics.updated(0)) << "it counts no iterations";
  const auto& covariance = written.result.diagnostics.scans[0].covariance;
  ASSERT_TRUE(diagnostics.scans[0].covariance);
  EXPECT_EQ(diagnostics.scans[0].covariance->position, covariance->position);
  EXPECT_EQ(diagnostics.scans[0].covariance->rotation, covariance->rotation);
  EXPECT_FALSE(diagnostics.scans[1].covariance);
  EXPECT_FALSE(read->result.optimized);
}

TEST(DiagnosticsTable, OfAnotherProgramMayLackSeriesButNotTheStamps) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "diagnostics.csv";
  ASSERT_TRUE(write_file_atomically(file, "stamp_s,D\n1,0.5\n"));
  const auto few = read_diagnostics(file);
  ASSERT_TRUE(few) << few.error().message;
  EXPECT_EQ(few->value(0, "D"), 0.5);
  EXPECT_FALSE(few->scans[0].covariance);
  ASSERT_TRUE(write_file_atomically(file, "time,D\n1,0.5\n"));
  const auto none = read_diagnostics(file);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("diagnostics.csv:1: expected the column stamp_s"),
            std::string::npos)
      << none.error().message;
}

TEST(Estimator, MayHaveAReoptimizedTrajectoryInAFileOfItsOwn) {
  const TemporaryFolder folder;
  EstimatorOutcome written = outcome();
  written.result.optimized = Trajectory{{3 * kSecond, Pose()}};
  ASSERT_TRUE(write_estimator(written, folder.path(), "other"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "other.optimized.tum"));
  const auto read = read_estimator(folder.path(), "other");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_TRUE(read->result.optimized);
  EXPECT_EQ(read->result.optimized->front().stamp, 3 * kSecond);
  EXPECT_EQ(read->result.trajectory.size(), 2U);
}

}  // namespace
}  // namespace aims
