// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/suite_progress.hpp"

#include <algorithm>

namespace aims {

ProgressCount::ProgressCount(std::size_t total, const SuiteObserver& observer)
    : observer_(observer), total_(total) {}

bool ProgressCount::advance(const void* key, const Progress& progress) {
  const std::lock_guard lock(mutex_);
  under_way_[key] = std::clamp(progress.simulated_s / progress.expected_s, 0.0, 0.99);
  tell();
  return wanted_;
}

void ProgressCount::finish(const void* key) {
  const std::lock_guard lock(mutex_);
  under_way_.erase(key);
  ++done_;
  tell();
}

bool ProgressCount::wanted() const {
  const std::lock_guard lock(mutex_);
  return wanted_;
}

void ProgressCount::tell() {
  SuiteProgress progress{done_, total_, 0.0, std::nullopt};
  progress.elapsed_s = stopwatch_.seconds();
  double runs = static_cast<double>(done_);
  for (const auto& [key, share] : under_way_) runs += share;
  if (runs > 0.0) {
    progress.left_s = progress.elapsed_s * (static_cast<double>(total_) - runs) / runs;
  }
  if (!observer_(progress)) wanted_ = false;
}

}  // namespace aims
