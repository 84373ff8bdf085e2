// SPDX-License-Identifier: BSD-3-Clause
#include "harness/timed_estimator.hpp"

#include <chrono>
#include <utility>

namespace aims {

TimedEstimator::TimedEstimator(std::string name, std::unique_ptr<Estimator> estimator)
    : name_(std::move(name)), estimator_(std::move(estimator)) {}

void TimedEstimator::consume(std::span<const Delivery> deliveries) {
  for (const Delivery& delivery : deliveries) {
    timed([&] { estimator_->consume(delivery); });
  }
}

void TimedEstimator::finish() {
  timed([&] { estimator_->finish(); });
}

template <class Work>
void TimedEstimator::timed(const Work& work) {
  using Clock = std::chrono::steady_clock;
  const std::size_t poses_before = estimator_->report().trajectory.size();
  const Clock::time_point start = Clock::now();
  work();
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  total_seconds_ += seconds;
  seconds_since_pose_ += seconds;
  const std::size_t new_poses = estimator_->report().trajectory.size() - poses_before;
  for (std::size_t i = 0; i < new_poses; ++i) {
    scan_times_ms_.push_back(1e3 * seconds_since_pose_ / static_cast<double>(new_poses));
  }
  if (new_poses > 0) seconds_since_pose_ = 0.0;
}

}  // namespace aims
