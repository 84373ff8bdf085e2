// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/inspection/topic_statistics.hpp"

#include <algorithm>
#include <cmath>

#include "core/median.hpp"
#include "recordings/stream/record_clock.hpp"

namespace aims {
namespace {

constexpr std::size_t kMaxSamples = 1'000'000;
/// Ratio to the typical spacing above which messages may be lost [-].
constexpr double kLossThreshold = 1.5;
constexpr std::size_t kCatchUp = 5;     ///< spacings on either side that may make up for a long one
constexpr std::size_t kSpan = 4;        ///< spacings over which jitter is averaged
constexpr std::size_t kFewestSame = 3;  ///< messages of a clock that stands still
constexpr double kMinStep = 0.2;        ///< of the recorder's clock [s]

/// Differences in seconds, of which those of repeated and earlier stamps are left out.
std::vector<double> forward(const std::vector<double>& spacings) {
  std::vector<double> result;
  std::ranges::copy_if(spacings, std::back_inserter(result),
                       [](double each) { return each > 0.0; });
  return result;
}

/// The median spacing; of messages that jitter, that over a few of them.
std::optional<double> typical_spacing(const std::vector<double>& spacings) {
  const auto median = upper_median(spacings);
  if (!median || spacings.size() <= 2 * kSpan) return median;
  const auto near = std::ranges::count_if(
      spacings, [&](double each) { return std::abs(each - *median) < 0.2 * *median; });
  if (3 * static_cast<std::size_t>(near) >= 2 * spacings.size()) return median;
  std::vector<double> means;
  for (std::size_t i = 0; i + kSpan <= spacings.size(); ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < kSpan; ++k) sum += spacings[i + k];
    means.push_back(sum / kSpan);
  }
  return upper_median(means);
}

/// Fraction of messages missing, at a nominal spacing of `typical` seconds: long spacings for which
/// short ones nearby do not make up.
double loss_of(const std::vector<double>& spacings, double typical) {
  double missing = 0.0;
  for (std::size_t i = 0; i < spacings.size(); ++i) {
    if (spacings[i] <= kLossThreshold * typical) continue;
    const std::size_t begin = i < kCatchUp ? 0 : i - kCatchUp;
    const std::size_t end = std::min(spacings.size(), i + kCatchUp + 1);
    double around = 0.0, rest = 0.0;
    for (std::size_t k = begin; k < end; ++k) {
      around += spacings[k] / typical;
      // Other losses nearby count themselves.
      if (k != i) rest += std::max(1.0, std::round(spacings[k] / typical));
    }
    const double alone = std::round(spacings[i] / typical) - 1.0;
    missing += std::clamp(std::round(around - rest) - 1.0, 0.0, std::max(alone, 0.0));
  }
  return missing / (missing + static_cast<double>(spacings.size()) + 1.0);
}

}  // namespace

void TopicStatistics::add(Time record_time, std::optional<Time> stamp) {
  if (messages_++ == 0) stamped_ = stamp.has_value();
  if (entries_.size() < kMaxSamples) entries_.push_back({record_time, stamp.value_or(record_time)});
}

bool TopicStatistics::recorder_was_set_back(TopicInfo& info) {
  std::vector<Entry> sorted = entries_;
  std::ranges::stable_sort(sorted, {}, &Entry::stamp);
  std::size_t steps = 0;
  double largest = 0.0;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double step = to_seconds((sorted[i].record - sorted[i].stamp) -
                                   (sorted[i - 1].record - sorted[i - 1].stamp));
    if (step > -kMinStep) continue;
    ++steps;
    largest = std::max(largest, -step);
  }
  // A clock is set a few times; stamps in disorder step again and again.
  if (steps == 0 || steps > 1 + sorted.size() / 100) return false;
  if (std::ranges::is_sorted(entries_, {}, &Entry::stamp)) return false;
  info.recorder_step_s = largest;
  entries_ = std::move(sorted);
  return true;
}

void TopicStatistics::finish_spacings(TopicInfo& info) const {
  std::vector<double> spacings;
  for (std::size_t i = 1; i < entries_.size(); ++i) {
    spacings.push_back(to_seconds(entries_[i].stamp - entries_[i - 1].stamp));
    if (spacings.back() == 0.0) ++info.repeated;
    if (spacings.back() < 0.0) ++info.backwards;
  }
  const std::vector<double> onwards = forward(spacings);
  const auto typical = typical_spacing(onwards);
  if (!typical || !(*typical > 0.0)) return;
  info.rate_hz = 1.0 / *typical;
  if (info.repeated > onwards.size()) {
    const auto messages = static_cast<double>(entries_.size());
    info.messages_per_stamp = messages / static_cast<double>(onwards.size() + 1);
    info.rate_hz = *info.messages_per_stamp / *typical;
  }
  info.largest_gap_s = std::ranges::max(onwards);
  info.loss = loss_of(onwards, *typical);
}

void TopicStatistics::finish_offsets(TopicInfo& info) const {
  std::vector<double> offsets;
  for (const Entry& each : entries_) offsets.push_back(to_seconds(each.record - each.stamp));
  if (offsets.empty()) return;
  info.median_offset_s = upper_median(offsets);
  const auto [smallest, largest] = std::ranges::minmax(offsets);
  info.smallest_offset_s = smallest;
  info.largest_offset_s = largest;
}

void TopicStatistics::finish(TopicInfo& info) {
  info.messages = messages_;
  const auto is_first = [&](const Entry& e) { return e.stamp == entries_.front().stamp; };
  const bool same = stamped_ && entries_.size() > 1 && std::ranges::all_of(entries_, is_first);
  info.zero_stamps = same && entries_.front().stamp == 0;
  info.same_stamps = same && !info.zero_stamps && entries_.size() >= kFewestSame;
  info.stamped = stamped_ && !info.zero_stamps && !info.same_stamps;
  if (info.zero_stamps || info.same_stamps) {
    for (Entry& each : entries_) each.stamp = each.record;
  }
  const auto unset = [](const Entry& each) {
    return each.record < kSetRecordTime && each.stamp > kSetRecordTime;
  };
  std::vector<Entry> first;
  std::ranges::copy_if(entries_, std::back_inserter(first), unset);
  info.unset_record_times = first.size() < entries_.size() ? first.size() : 0;
  if (!first.empty() && first.size() < entries_.size()) {
    std::erase_if(entries_, unset);
    finish_offsets(info);
    // Their stamps are in order among the others.
    entries_.insert(entries_.end(), first.begin(), first.end());
    std::ranges::stable_sort(entries_, {}, &Entry::stamp);
  } else {
    if (info.stamped) {
      recorder_was_set_back(info);
      finish_offsets(info);
    }
  }
  if (!entries_.empty()) {
    info.first_stamp = entries_.front().stamp;
    info.last_stamp = entries_.back().stamp;
  }
  finish_spacings(info);
}

}  // namespace aims
