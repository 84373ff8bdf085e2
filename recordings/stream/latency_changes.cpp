// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/latency_changes.hpp"

#include <algorithm>
#include <cstdlib>

#include "core/median.hpp"

namespace aims {
namespace {

constexpr std::size_t kFewestSeconds = 3;        ///< of each third
constexpr Duration kLeastChange = kSecond / 10;  ///< by which scans and IMU no longer fit

Duration median_of(const std::vector<Duration>& series, std::size_t begin, std::size_t end) {
  const auto first = series.begin();
  return *upper_median(std::vector<Duration>(first + static_cast<std::ptrdiff_t>(begin),
                                             first + static_cast<std::ptrdiff_t>(end)));
}

}  // namespace

SeriesGrowth growth_of(const std::vector<Duration>& series) {
  const std::size_t third = series.size() / 3;
  const Duration first = median_of(series, 0, third);
  const Duration middle = median_of(series, third, 2 * third);
  const Duration last = median_of(series, 2 * third, 3 * third);
  const Duration uneven = std::abs(last - 2 * middle + first);
  return {last - first, 4 * uneven <= std::abs(last - first)};
}

std::optional<SeriesLeap> leap_of(const std::vector<Duration>& series, const LeapRule& rule) {
  std::size_t at = 0;
  Duration largest = rule.least_sudden;
  for (std::size_t i = rule.margin; i + rule.margin <= series.size(); ++i) {
    const Duration step = std::abs(series[i] - series[i - 1]);
    if (step <= largest) continue;
    largest = step;
    at = i;
  }
  if (at == 0) return std::nullopt;
  const Duration before = median_of(series, 0, at), behind = median_of(series, at, series.size());
  const Duration step = behind - before;
  const Duration near = rule.near.value_or(std::abs(step) / 4);
  std::size_t strays = 0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    strays += std::abs(series[i] - (i < at ? before : behind)) > near ? 1 : 0;
  }
  if (std::abs(step) < rule.least || 10 * strays >= series.size()) return std::nullopt;
  return SeriesLeap{at, step};
}

void LatencyTrend::add(Time recorded, Duration latency) {
  const Time second = recorded / kSecond;
  if (!seconds_.empty() && second < seconds_.back().first) return;
  if (seconds_.empty() || second > seconds_.back().first) {
    seconds_.emplace_back(second, latency);
  } else {
    seconds_.back().second = std::min(seconds_.back().second, latency);
  }
}

std::optional<double> LatencyTrend::growth(const LatencyTrend& other) const {
  const auto [seconds, apart] = apart_from(other);
  const std::size_t third = apart.size() / 3;
  if (third < kFewestSeconds) return std::nullopt;
  const SeriesGrowth growth = growth_of(apart);
  if (std::abs(growth.grown) < kLeastChange || !growth.is_even) return std::nullopt;
  // From the middle of the first third to that of the last; some seconds may be missing.
  const Time between = seconds[2 * third + third / 2] - seconds[third / 2];
  return to_seconds(growth.grown) / static_cast<double>(between);
}

std::optional<Duration> LatencyTrend::step(const LatencyTrend& other) const {
  const auto leap =
      leap_of(apart_from(other).latencies, {.margin = kFewestSeconds, .least = kLeastChange});
  return leap ? std::optional(leap->step) : std::nullopt;
}

LatencyTrend::Apart LatencyTrend::apart_from(const LatencyTrend& other) const {
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

}  // namespace aims
