// SPDX-License-Identifier: BSD-3-Clause
// How latencies change: evenly, as of clocks that run at different rates, or once and for good, as
// of a clock that leaps.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/time.hpp"

namespace aims {

/// By how much a series of three values or more grows from its first third to its last, by their
/// medians.
struct SeriesGrowth {
  Duration grown = 0;
  bool is_even = false;  ///< its halves grow by much the same
};
SeriesGrowth growth_of(const std::vector<Duration>& series);

/// A leap of a series, of which more than nine values of ten stay near the median of their side.
struct SeriesLeap {
  std::size_t at = 0;  ///< the first value behind it
  Duration step = 0;   ///< from median to median
};

/// What counts as a leap.
struct LeapRule {
  std::size_t margin = 1;     ///< values before and behind it
  Duration least = 0;         ///< step
  Duration least_sudden = 0;  ///< from one value to the next; more than it
  std::optional<Duration> near =
      std::nullopt;  ///< of values to the median; none: a quarter of the step
};
std::optional<SeriesLeap> leap_of(const std::vector<Duration>& series, const LeapRule& rule);

/// The shortest latency of a topic in each second of the recording.
class LatencyTrend {
 public:
  /// `latency`: record time minus stamp.
  void add(Time recorded, Duration latency);

  /// By how much the latency grows against that of the other topic in a second [s/s], where it does
  /// so evenly over the whole recording; nothing where it hardly grows.
  std::optional<double> growth(const LatencyTrend& other) const;

  /// By how much it steps against that of the other topic, once and for good.
  std::optional<Duration> step(const LatencyTrend& other) const;

 private:
  /// Differences of latencies, of the seconds that both have.
  struct Apart {
    std::vector<Time> seconds;
    std::vector<Duration> latencies;
  };
  Apart apart_from(const LatencyTrend& other) const;

  std::vector<std::pair<Time, Duration>> seconds_;
};

}  // namespace aims
