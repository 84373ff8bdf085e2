// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/timed_estimator.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <thread>

namespace aims {
namespace {

/// Has a pose per delivery, after work that another thread does while this one waits.
class WaitingEstimator : public Estimator {
 public:
  void consume(const Delivery& delivery) override {
    std::thread([] {
      volatile std::uint64_t state = 1;
      for (int i = 0; i < 20'000'000; ++i) state = state * 6364136223846793005U + 1U;
    }).join();
    result_.trajectory.push_back({delivery.arrival, Pose()});
  }
  void finish() override {}
  const EstimatorResult& result() const override { return result_; }
  std::vector<Eigen::Vector3f> map_points() const override { return {}; }

 private:
  EstimatorResult result_;
};

TEST(TimedEstimator, CountsWaitingAsWallTimeAndNotAsProcessorTime) {
  TimedEstimator timed("waiting", std::make_unique<WaitingEstimator>());
  const std::vector<Delivery> deliveries(3);
  timed.consume(deliveries);
  timed.finish();
  const ScanTimes& times = timed.scan_times();
  ASSERT_EQ(times.wall_ms.size(), 3U);
  ASSERT_EQ(times.cpu_ms.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_GT(times.cpu_ms[i], 0.0);
    EXPECT_LT(times.cpu_ms[i], 0.5 * times.wall_ms[i]);
  }
}

/// Has a pose, a scan and a row of health per delivery, and keeps the last ones.
class ForgetfulEstimator : public Estimator {
 public:
  ForgetfulEstimator() { result_.diagnostics.series = {{"number", "-", "of the scan"}}; }
  void consume(const Delivery& delivery) override {
    result_.trajectory.push_back({delivery.arrival, Pose()});
    result_.diagnostics.scans.push_back({delivery.arrival, std::nullopt, {1.0 * ++count_}});
    result_.health.push_back({delivery.arrival, HealthState::kHealthy, {}, 0.0});
  }
  void finish() override {}
  const EstimatorResult& result() const override { return result_; }
  void forget_rows() override { keep_last_rows(result_); }
  std::vector<Eigen::Vector3f> map_points() const override { return {}; }

 private:
  EstimatorResult result_;
  int count_ = 0;
};

TEST(TimedEstimator, HandsOutEachRowOnceWhetherTheEstimatorForgetsThemOrNot) {
  for (const bool forgets : {false, true}) {
    TimedEstimator timed("forgetful", std::make_unique<ForgetfulEstimator>());
    Time next = 0;
    std::vector<double> numbers;
    std::size_t poses = 0;
    std::size_t health = 0;
    for (const std::size_t count : {3U, 0U, 1U, 4U}) {
      for (std::size_t i = 0; i < count; ++i) {
        const Delivery delivery = {next += kSecond, {}};
        timed.consume({&delivery, 1});
      }
      const EstimatorRows rows = timed.rows();
      for (const ScanRow& scan : rows.scans) numbers.push_back(scan.values[0]);
      EXPECT_EQ(rows.wall_ms.size(), rows.scans.size());
      poses += rows.poses.size();
      health += rows.health.size();
      if (forgets) {
        timed.forget();
        EXPECT_EQ(timed.estimator().result().trajectory.size(), 1U);
        EXPECT_EQ(timed.estimator().result().diagnostics.scans.size(), 1U);
        EXPECT_EQ(timed.estimator().result().health.size(), 1U);
      } else {
        timed.pass();
      }
    }
    EXPECT_EQ(numbers, (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8}));
    EXPECT_EQ(poses, 8U);
    EXPECT_EQ(health, 8U);
    EXPECT_EQ(timed.scan_times().wall_ms.size(), 8U);
  }
}

}  // namespace
}  // namespace aims
