// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/time.hpp"

namespace aims {

/// Counts the messages of a topic that were not recorded, by gaps in its stamps.
class MissingMessages {
 public:
  void add(Time stamp, Time recorded, Duration period) {
    const Duration step = stamp - stamp_, waited = recorded - recorded_;
    const bool first = received_++ == 0;
    stamp_ = stamp;
    recorded_ = recorded;
    // Where stamps alone go on, or for long, it is no loss.
    if (first || period <= 0 || step <= 0 || step > kLongest || 2 * waited < step) return;
    const double periods = static_cast<double>(step) / static_cast<double>(period);
    periods_ += periods;
    ++steps_;
    if (periods <= kGap) return;
    ++gaps_;
    in_gaps_ += std::round(periods) - 1.0;
  }

  /// Short steps make up for long ones of messages that jitter.
  std::int64_t count() const {
    return std::llround(std::max(0.0, std::min(in_gaps_, periods_ - static_cast<double>(steps_))));
  }
  std::int64_t received() const { return received_; }
  std::int64_t gaps() const { return gaps_; }

 private:
  static constexpr Duration kLongest = 10 * kSecond;
  static constexpr double kGap = 1.5;  ///< periods

  Time stamp_ = 0, recorded_ = 0;
  std::int64_t received_ = 0, steps_ = 0, gaps_ = 0;
  double periods_ = 0.0, in_gaps_ = 0.0;
};

}  // namespace aims
