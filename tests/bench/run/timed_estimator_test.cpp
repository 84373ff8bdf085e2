// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/timed_estimator.hpp"

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

}  // namespace
}  // namespace aims
