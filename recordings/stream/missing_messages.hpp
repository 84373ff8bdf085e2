// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "core/time.hpp"

namespace aims {

/// Counts the messages of a topic that did not come, by gaps of up to an hour in its stamps; and
/// notes when it was heard.
class MissingMessages {
 public:
  static constexpr Duration kLong = 10 * kSecond;  ///< of gaps that are named

  /// `recorded` is without what the recorder was late or held it for, `arrived` with it.
  void add(Time stamp, Time recorded, Time arrived, Duration period) {
    hear(recorded, arrived);
    const bool first = received_++ == 0;
    // Behind the newest one they are of a second publisher, or late; many, and the clock was set.
    if (!first && stamp <= stamp_ && ++behind_ < kSetBack) return;
    const Duration step = stamp - stamp_, waited = recorded - recorded_;
    const std::int64_t unusable = std::exchange(unusable_, 0);
    const Duration silence = std::exchange(longest_wait_, 0);
    behind_ = 0;
    stamp_ = stamp;
    recorded_ = recorded;
    // Where stamps alone go on, it is no loss; after hours a clock was set, or all began anew.
    if (first || period <= 0 || step <= 0 || step > kLongest || 2 * waited < step) return;
    const double periods = static_cast<double>(step) / static_cast<double>(period);
    const double gap = std::max(0.0, std::round(periods) - 1.0);
    const double came = std::min(static_cast<double>(unusable), gap);
    periods_ += periods - came;
    received_ += static_cast<std::int64_t>(came);
    ++steps_;
    if (periods <= kGap || came == gap) return;
    ++gaps_;
    in_gaps_ += gap - came;
    // Of which nothing is read came in it: it is no longer than the longest time without any.
    const Duration pause = unusable > 0 ? std::min(step, silence) : step;
    if (pause > kLong) in_long_gaps_ += gap - came;
    longest_ = std::max(longest_, pause);
  }

  /// A message came, but there is nothing in it to read: it has another count.
  void add_unusable(Time recorded, Time arrived) {
    hear(recorded, arrived);
    ++unusable_;
  }

  /// Short steps make up for long ones of messages that jitter.
  std::int64_t count() const {
    return std::llround(std::max(0.0, std::min(in_gaps_, periods_ - static_cast<double>(steps_))));
  }
  /// Of these, in gaps longer than `kLong`.
  std::int64_t in_long_gaps() const {
    return std::min<std::int64_t>(count(), std::llround(in_long_gaps_));
  }
  std::int64_t received() const { return received_; }
  /// Of all messages that were sent, those that are missing.
  double fraction() const {
    const auto missing = static_cast<double>(count());
    return missing / std::max(1.0, missing + static_cast<double>(received_));
  }
  std::int64_t gaps() const { return gaps_; }
  Duration longest() const { return longest_; }

  /// When the first and the last message of any kind arrived; nothing: there is none.
  const std::optional<std::pair<Time, Time>>& heard() const { return heard_; }

 private:
  static constexpr double kGap = 1.5;  ///< periods
  static constexpr int kSetBack = 100;
  static constexpr Duration kLongest = 3600 * kSecond;

  void hear(Time recorded, Time arrived) {
    if (newest_) longest_wait_ = std::max(longest_wait_, recorded - *newest_);
    newest_ = std::max(newest_.value_or(recorded), recorded);
    if (!heard_) heard_ = {arrived, arrived};
    heard_->second = std::max(heard_->second, arrived);
  }

  Time stamp_ = 0, recorded_ = 0;  ///< of the newest message that was read
  int behind_ = 0;                 ///< messages since then
  std::optional<Time> newest_;     ///< message of any kind
  std::optional<std::pair<Time, Time>> heard_;
  Duration longest_wait_ = 0;  ///< between messages of any kind since then
  std::int64_t received_ = 0, unusable_ = 0, steps_ = 0, gaps_ = 0;
  double periods_ = 0.0, in_gaps_ = 0.0, in_long_gaps_ = 0.0;
  Duration longest_ = 0;
};

}  // namespace aims
