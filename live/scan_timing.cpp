// SPDX-License-Identifier: BSD-3-Clause
#include "live/scan_timing.hpp"

#include <algorithm>
#include <variant>

#include "live/inbox.hpp"

namespace aims {
namespace {

/// In which the estimator catches up with what was gathered before it started.
constexpr Duration kCatchUp = 2 * kSecond;
constexpr double kRatePeriod = 0.9;  ///< [s]

}  // namespace

ScanTiming::ScanTiming() : first_(wall_time() + kCatchUp), rates_from_(wall_time()) {}

void ScanTiming::arrived(const Delivery& delivery, Time arrival) {
  if (std::holds_alternative<ImuSample>(delivery.measurement)) ++samples_;
  const auto* scan = std::get_if<LidarScanPtr>(&delivery.measurement);
  if (scan == nullptr) return;
  ++scans_;
  if (arrival >= first_) waiting_.emplace_back((*scan)->end, arrival);
}

void ScanTiming::published(Time stamp) {
  while (!waiting_.empty() && waiting_.front().first < stamp) waiting_.pop_front();
  if (waiting_.empty() || waiting_.front().first != stamp) return;
  const Duration taken = wall_time() - waiting_.front().second;
  ++counts_[static_cast<std::size_t>(
      std::clamp<Duration>(taken / kMillisecond, 0, counts_.size() - 1))];
  ++total_;
}

std::size_t ScanTiming::quantile(double part) const {
  std::size_t sum = 0;
  for (std::size_t i = 0; i < counts_.size() && total_ > 0; ++i) {
    sum += counts_[i];
    if (static_cast<double>(sum) >= part * static_cast<double>(total_)) return i;
  }
  return 0;
}

std::pair<double, double> ScanTiming::rates() {
  const double seconds = to_seconds(wall_time() - rates_from_);
  if (seconds < kRatePeriod) return rates_;
  rates_from_ = wall_time();
  rates_ = {static_cast<double>(std::exchange(scans_, 0)) / seconds,
            static_cast<double>(std::exchange(samples_, 0)) / seconds};
  return rates_;
}

}  // namespace aims
