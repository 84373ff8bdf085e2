// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/inspection/topic_statistics.hpp"

#include <algorithm>
#include <cmath>

#include "recordings/median.hpp"

namespace aims {
namespace {

constexpr std::size_t kMaxSamples = 1'000'000;
/// Ratio to the median above which a spacing means lost messages [-].
constexpr double kLossThreshold = 1.5;

/// Fraction of messages missing, at a nominal spacing of `typical` seconds.
double loss_of(const std::vector<float>& spacings, double typical) {
  double missing = 0.0;
  for (const float spacing : spacings) {
    if (spacing > kLossThreshold * typical) missing += std::round(spacing / typical) - 1.0;
  }
  return missing / (missing + static_cast<double>(spacings.size()) + 1.0);
}

}  // namespace

void TopicStatistics::add(Time record_time, std::optional<Time> stamp) {
  const Time time = stamp.value_or(record_time);
  if (messages_ == 0) {
    first_ = time;
    stamped_ = stamp.has_value();
  } else {
    const double spacing = to_seconds(time - last_);
    if (spacing == 0.0) ++repeated_;
    if (spacing < 0.0) ++backwards_;
    largest_gap_s_ = std::max(largest_gap_s_, spacing);
    if (spacing > 0.0 && spacings_s_.size() < kMaxSamples) {
      spacings_s_.push_back(static_cast<float>(spacing));
    }
  }
  if (stamp && offsets_s_.size() < kMaxSamples) {
    offsets_s_.push_back(static_cast<float>(to_seconds(record_time - *stamp)));
  }
  last_ = time;
  ++messages_;
}

void TopicStatistics::finish(TopicInfo& info) {
  info.messages = messages_;
  info.stamped = stamped_;
  info.repeated = repeated_;
  info.backwards = backwards_;
  info.first_stamp = first_;
  info.last_stamp = last_;
  if (const auto typical = upper_median(spacings_s_); typical && *typical > 0.0) {
    info.rate_hz = 1.0 / *typical;
    info.largest_gap_s = largest_gap_s_;
    info.loss = loss_of(spacings_s_, *typical);
  }
  if (offsets_s_.empty()) return;
  info.median_offset_s = upper_median(offsets_s_);
  const auto [smallest, largest] = std::minmax_element(offsets_s_.begin(), offsets_s_.end());
  info.smallest_offset_s = *smallest;
  info.largest_offset_s = *largest;
}

}  // namespace aims
