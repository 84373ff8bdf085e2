// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include "core/time.hpp"
#include "recordings/stream/series_change.hpp"

namespace aims {

/// The shortest latency of a topic in each second of the recording, by which clocks that run at
/// different rates are told.
class LatencyTrend {
 public:
  /// `latency`: record time minus stamp.
  void add(Time recorded, Duration latency) {
    const Time second = recorded / kSecond;
    if (!seconds_.empty() && second < seconds_.back().first) return;
    if (seconds_.empty() || second > seconds_.back().first) {
      seconds_.emplace_back(second, latency);
    } else {
      seconds_.back().second = std::min(seconds_.back().second, latency);
    }
  }

  /// By how much the latency grows against that of the other topic in a second [s/s], where it does
  /// so evenly over the whole recording; nothing where it hardly grows.
  std::optional<double> growth(const LatencyTrend& other) const {
    const auto [seconds, apart] = apart_from(other);
    const std::size_t third = apart.size() / 3;
    if (apart.size() < 3 * kFewest) return std::nullopt;
    const SeriesGrowth growth(medians_of_thirds(apart));
    if (std::abs(growth.grown) < kLeast || !growth.is_even()) return std::nullopt;
    // From the middle of the first third to that of the last; some seconds may be missing.
    const Time between = seconds[2 * third + third / 2] - seconds[third / 2];
    return to_seconds(growth.grown) / static_cast<double>(between);
  }

  /// By how much it steps against that of the other topic, once and for good.
  std::optional<Duration> step(const LatencyTrend& other) const {
    const std::vector<Duration> apart = apart_from(other).latencies;
    const auto quarter = [](Duration step) { return step / 4; };
    const auto leap = largest_leap(apart, kFewest, 0, quarter);
    if (!leap || std::abs(leap->step()) < kLeast || 10 * leap->strays > apart.size()) {
      return std::nullopt;
    }
    return leap->step();
  }

 private:
  /// Differences of latencies, of the seconds that both have.
  struct Apart {
    std::vector<Time> seconds;
    std::vector<Duration> latencies;
  };
  Apart apart_from(const LatencyTrend& other) const {
    Apart apart;
    auto at = other.seconds_.begin();
    for (const auto& [second, latency] : seconds_) {
      while (at != other.seconds_.end() && at->first < second) ++at;
      if (at == other.seconds_.end() || at->first != second) continue;
      apart.seconds.push_back(second);
      apart.latencies.push_back(latency - at->second);
    }
    return apart;
  }

  static constexpr std::size_t kFewest = 3;         ///< seconds of each third
  static constexpr Duration kLeast = kSecond / 10;  ///< by which scans and IMU no longer fit

  std::vector<std::pair<Time, Duration>> seconds_;
};

}  // namespace aims
