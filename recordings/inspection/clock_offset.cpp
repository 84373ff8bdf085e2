// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/inspection/clock_offset.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

constexpr Duration kGrid = 5 * kMillisecond;
constexpr int kMaxLag = 100;             ///< grid steps: half a second
constexpr double kMinOverlap = 10.0;     ///< common time [s]
constexpr double kMaxOverlap = 120.0;    ///< of it that is used [s]
constexpr double kMinDeviation = 0.01;   ///< standard deviation of the rates [rad/s]
constexpr double kMinCorrelation = 0.6;  ///< correlation

/// The rate every `kGrid` from `begin` on, interpolated linearly, minus its mean.
std::vector<double> resampled(const std::vector<TurnRate>& rates, Time begin, std::size_t count) {
  std::vector<double> values(count);
  std::size_t next = 1;
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const Time at = begin + static_cast<Time>(i) * kGrid;
    while (next + 1 < rates.size() && rates[next].stamp < at) ++next;
    const TurnRate& a = rates[next - 1];
    const TurnRate& b = rates[next];
    const double fraction =
        std::clamp(to_seconds(at - a.stamp) / to_seconds(b.stamp - a.stamp), 0.0, 1.0);
    values[i] = a.rate + fraction * (b.rate - a.rate);
    sum += values[i];
  }
  for (double& value : values) value -= sum / static_cast<double>(count);
  return values;
}

double energy(const std::vector<double>& values, std::size_t from, std::size_t to) {
  double sum = 0.0;
  for (std::size_t i = from; i < to; ++i) sum += values[i] * values[i];
  return sum;
}

/// Correlation of `a` with `b` for `a` delayed by `lag` grid steps; |lag| <= kMaxLag.
double correlation(const std::vector<double>& a, const std::vector<double>& b, int lag) {
  const std::size_t count = b.size() - 2 * kMaxLag;
  const auto shift = static_cast<std::size_t>(kMaxLag + lag);
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += a[shift + i] * b[kMaxLag + i];
  const double norm = energy(a, shift, shift + count) * energy(b, kMaxLag, kMaxLag + count);
  return norm > 0.0 ? sum / std::sqrt(norm) : 0.0;
}

}  // namespace

std::optional<ClockOffset> clock_offset(const std::vector<TurnRate>& rates,
                                        const std::vector<TurnRate>& reference) {
  if (rates.size() < 2 || reference.size() < 2) return std::nullopt;
  const Time begin = std::max(rates.front().stamp, reference.front().stamp);
  const Time end = std::min(rates.back().stamp, reference.back().stamp);
  if (to_seconds(end - begin) < kMinOverlap) return std::nullopt;
  const double span = std::min(to_seconds(end - begin), kMaxOverlap);
  const auto count = static_cast<std::size_t>(span / to_seconds(kGrid));
  const std::vector<double> a = resampled(rates, begin, count);
  const std::vector<double> b = resampled(reference, begin, count);
  const double min_energy = kMinDeviation * kMinDeviation * static_cast<double>(count);
  if (energy(a, 0, count) < min_energy || energy(b, 0, count) < min_energy) return std::nullopt;

  std::vector<double> by_lag;
  for (int lag = -kMaxLag; lag <= kMaxLag; ++lag) by_lag.push_back(correlation(a, b, lag));
  const auto peak = std::max_element(by_lag.begin(), by_lag.end());
  if (*peak < kMinCorrelation || peak == by_lag.begin() || peak + 1 == by_lag.end()) {
    return std::nullopt;
  }
  // The top of the parabola through the peak and its neighbours.
  const double before = *(peak - 1);
  const double after = *(peak + 1);
  const double curvature = before - 2.0 * *peak + after;
  const double fraction = curvature < 0.0 ? 0.5 * (before - after) / curvature : 0.0;
  const double lag = static_cast<double>(peak - by_lag.begin()) - kMaxLag + fraction;
  return ClockOffset{lag * to_seconds(kGrid), *peak};
}

}  // namespace aims
