// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <optional>

#include "core/time.hpp"

namespace aims {

/// Whether record times of a topic fit its stamps: they do not behind a recorder's clock that was
/// set.
class SteadyTopic {
 public:
  /// `late`: how long after its stamp and the usual latency a message was recorded.
  void add(Duration late, Time recorded) {
    if (std::abs(late) < kUsual) {
      ++usual_;
    } else {
      odd_ = recorded;
    }
  }
  int usual() const { return usual_; }
  bool was_always_steady() const { return !odd_; }
  bool is_steady(Time now) const { return !odd_ || now - *odd_ > kQuiet; }

  static constexpr Duration kUsual = kSecond / 4;

 private:
  static constexpr Duration kQuiet = 5 * kSecond;
  int usual_ = 0;
  std::optional<Time> odd_;  ///< when the last such message was recorded
};

/// Finds stamps of a topic that leap for good, while those of a denser, steady topic go on. A delay
/// moves no stamp, and a recorder's clock moves the record times of both.
class StampLeaps {
 public:
  /// By how much the stamp of a message is wrong, if stamps leapt before it.
  std::optional<Duration> add(Time stamp, Duration late, Time recorded, const SteadyTopic& steady) {
    if (std::abs(late) < SteadyTopic::kUsual) {
      usual_ = Instant{stamp, recorded};
      odd_ = false;
      return std::nullopt;
    }
    if (!odd_ || !steady.is_steady(recorded)) {
      leapt_ = steps(stamp, recorded) && steady.is_steady(recorded);
      odd_ = true;
      usual_before_ = steady.usual();
      return std::nullopt;
    }
    if (!leapt_ || steady.usual() < usual_before_ + kFewest) return std::nullopt;
    if (count_++ == 0) {
      first_ = recorded;
      leap_ = -late;
    }
    return -late;
  }

  int count() const { return count_; }
  Time first() const { return first_; }  ///< record time
  Duration leap() const { return leap_; }

 private:
  struct Instant {
    Time stamp = 0;
    Time recorded = 0;
  };
  static constexpr Duration kMostBetween = 2 * kSecond;
  static constexpr int kFewest = 3;  ///< messages of the other topic

  /// Whether the stamp steps farther than the record time since the last usual message.
  bool steps(Time stamp, Time recorded) const {
    if (!usual_) return false;
    const Duration waited = recorded - usual_->recorded;
    return waited >= 0 && waited < kMostBetween && std::abs(stamp - usual_->stamp) > waited;
  }

  std::optional<Instant> usual_;
  bool odd_ = false;      ///< the last message was
  bool leapt_ = false;    ///< by its stamp
  int usual_before_ = 0;  ///< messages of the other topic when it did
  int count_ = 0;
  Time first_ = 0;
  Duration leap_ = 0;
};

}  // namespace aims
