// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <utility>

#include "core/time.hpp"

namespace aims {

/// Tells apart why messages of a topic were recorded long after their stamps. Behind a recorder
/// that was stopped, or was too slow, stamps go on faster than record times until messages are as
/// late as ever; behind a clock that was set forward, all are as late as the first one.
class LateMessages {
 public:
  /// A message that is recorded so long after its stamp and latency is late.
  static constexpr Duration kLate = 5 * kSecond;

  /// `late`: how long after its stamp and the usual latency a message was recorded. Whether the
  /// counts may have changed.
  bool add(Duration late, Time recorded) {
    const Time due = recorded - late;
    const bool back = due + kSecond < std::exchange(last_due_, due);
    if (count_ == 0 && late < kLate) return false;
    if (count_ == 0) {
      first_late_ = late;
      first_recorded_ = recorded;
      in_order_ = !back;  // else times are wrong: a recorder reads in order
    }
    const Duration waited = recorded - first_recorded_;
    caught_up_ = in_order_ && waited >= 0 && first_late_ - late > waited;
    if (late >= kLate) {
      ++count_;
    } else {
      (caught_up_ ? read_late_ : by_clock_) += count_;
      count_ = 0;
    }
    return true;
  }

  int read_late() const { return read_late_ + (caught_up_ ? count_ : 0); }
  int by_clock() const { return by_clock_ + (caught_up_ ? 0 : count_); }

 private:
  // Of the late messages since the last one that was not.
  int count_ = 0;
  Duration first_late_ = 0;
  Time first_recorded_ = 0;
  bool in_order_ = true;
  bool caught_up_ = false;
  int read_late_ = 0, by_clock_ = 0;                  ///< of all before
  Time last_due_ = std::numeric_limits<Time>::min();  ///< stamp and usual latency of the last one
};

}  // namespace aims
