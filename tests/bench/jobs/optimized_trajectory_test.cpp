// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "bench/jobs/job_runner.hpp"
#include "bench/jobs/stored_results.hpp"
#include "bench/scoring/result_files.hpp"
#include "bench/scoring/score_table.hpp"
#include "core/files/tum.hpp"
#include "tests/bench/short_walk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::shared;
using testing::short_walk;

/// Leg odometry with positions 10 % short, which it makes good at the end: stands for an estimator
/// that closes loops. It has a series of its own and states no covariance.
class ShrinkingEstimator : public Estimator {
 public:
  ShrinkingEstimator() { result_.diagnostics.series = {{"speed", "m/s", "of the base"}}; }

  void consume(const Delivery& delivery) override {
    const auto* legs = std::get_if<LegOdometrySample>(&delivery.measurement);
    if (legs == nullptr) return;
    Pose pose = legs->T_odom_base;
    if (!first_) first_ = pose;
    pose = first_->inverse() * pose;
    pose.translation *= 0.9;
    result_.trajectory.push_back({legs->stamp, pose});
    result_.diagnostics.scans.push_back({legs->stamp, {}, {legs->linear_velocity.norm()}});
  }

  void finish() override {
    result_.optimized = result_.trajectory;
    for (StampedPose& each : *result_.optimized) each.pose.translation /= 0.9;
  }

  const EstimatorResult& result() const override { return result_; }
  std::vector<Eigen::Vector3f> map_points() const override { return {}; }

 private:
  EstimatorResult result_;
  std::optional<Pose> first_;
};

Result<EstimatorOutcome> shrinking(const Sequence& sequence, const Scenario& scenario,
                                   const std::string&, const PartObserver&) {
  TimedEstimator estimator("shrinking", std::make_unique<ShrinkingEstimator>());
  const auto replayed = sequence.reader.replay([&](const Delivery& delivery) {
    estimator.consume({&delivery, 1});
  });
  if (!replayed) return tl::unexpected(replayed.error());
  estimator.finish();
  EstimatorOutcome outcome = outcome_of(estimator);
  add_scores(sequence, scenario, outcome);
  return outcome;
}

TEST(OptimizedTrajectory, IsStoredAndScoredBesideTheOnlineOne) {
  const TemporaryFolder folder;
  JobOptions options;
  options.out = folder.path() / "out";
  options.cache = folder.path() / "cache";
  options.outputs = {.trajectories = true, .weak_axis = true};
  const std::vector<Job> jobs = {
      make_job(shared(short_walk()), 1, parse_estimator_spec("leg").value())};
  JobRunner runner(options, shrinking);
  const auto run = runner.run(jobs, [](const JobProgress&) { return true; });
  ASSERT_TRUE(run) << run.error().message;
  const auto result = runner.store().find(jobs[0].id);
  ASSERT_TRUE(result);
  ASSERT_EQ(result->outcome, JobOutcome::kDone) << result->message;

  const fs::path own = runner.store().outputs_of(jobs[0].id);
  const auto online = read_tum(own / "estimate.tum");
  const auto optimized = read_tum(own / "estimate.optimized.tum");
  ASSERT_TRUE(online && optimized);
  EXPECT_EQ(online->size(), optimized->size());

  const auto ate = score_in(*result, "ate_m");
  const auto optimized_ate = score_in(*result, "optimized.ate_m");
  ASSERT_TRUE(ate && optimized_ate);
  EXPECT_LT(*optimized_ate, 0.7 * *ate);
  EXPECT_TRUE(score_in(*result, "optimized.m_end_m"));
  EXPECT_FALSE(score_in(*result, "weak_axis.all.nees")) << "it states no covariance";

  const RunRecord record = record_of("short", 1, std::vector<LabelledResult>{{"mine", *result}});
  const TextTable table = score_table({&record, 1});
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0][0], "mine");
  EXPECT_EQ(table.rows[1][0], "mine (optimized)");
  EXPECT_EQ(table.rows[1].back(), "yes");
  EXPECT_NE(table.rows[0], table.rows[1]);
}

TEST(OptimizedTrajectory, HasNoRowWhereThereIsNone) {
  RunRecord record;
  record.scores["segments"] = Json::array();
  record.scores["estimators"]["mine"] = {{"success", true}, {"ate_m", 0.1}};
  EXPECT_EQ(score_table({&record, 1}).rows.size(), 1U);
}

}  // namespace
}  // namespace aims
