// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include "core/time.hpp"
#include "recordings/median.hpp"

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
    if (std::ssize(apart) < 3 * kFewest) return std::nullopt;
    std::array<Duration, 3> medians{};
    for (std::size_t i = 0; i < medians.size(); ++i) {
      const auto begin = apart.begin() + static_cast<std::ptrdiff_t>(i * third);
      medians[i] =
          *upper_median(std::vector<Duration>(begin, begin + static_cast<std::ptrdiff_t>(third)));
    }
    // From the middle of the first third to that of the last; some seconds may be missing.
    const Time between = seconds[2 * third + third / 2] - seconds[third / 2];
    const Duration grown = medians[2] - medians[0];
    const Duration uneven = std::abs(medians[2] - 2 * medians[1] + medians[0]);
    if (std::abs(grown) < kLeast || 4 * uneven > std::abs(grown)) return std::nullopt;
    return to_seconds(grown) / static_cast<double>(between);
  }

  /// By how much it steps against that of the other topic, once and for good.
  std::optional<Duration> step(const LatencyTrend& other) const {
    const std::vector<Duration> apart = apart_from(other).latencies;
    if (std::ssize(apart) < 2 * kFewest) return std::nullopt;
    auto largest = apart.begin();
    for (auto at = apart.begin() + 1; at != apart.end(); ++at) {
      const bool inside = at - apart.begin() >= kFewest && apart.end() - at >= kFewest;
      const bool larger =
          largest == apart.begin() || std::abs(*at - at[-1]) > std::abs(*largest - largest[-1]);
      if (inside && larger) largest = at;
    }
    if (largest == apart.begin()) return std::nullopt;
    const std::vector<Duration> before(apart.begin(), largest), behind(largest, apart.end());
    const Duration first = *upper_median(before), last = *upper_median(behind);
    const auto strays = [&](const std::vector<Duration>& part, Duration usual) {
      return std::ranges::count_if(
          part, [&](Duration each) { return 4 * std::abs(each - usual) > std::abs(last - first); });
    };
    const auto odd = strays(before, first) + strays(behind, last);
    if (std::abs(last - first) < kLeast || 10 * odd > std::ssize(apart)) return std::nullopt;
    return last - first;
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

  static constexpr std::ptrdiff_t kFewest = 3;      ///< seconds of each third
  static constexpr Duration kLeast = kSecond / 10;  ///< by which scans and IMU no longer fit

  std::vector<std::pair<Time, Duration>> seconds_;
};

}  // namespace aims
