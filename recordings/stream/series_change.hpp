// SPDX-License-Identifier: BSD-3-Clause
// How a series of latencies changes: evenly, as of clocks that run at different rates, or once and
// for good, as of a clock that leaps.
#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <vector>

#include "core/time.hpp"
#include "recordings/median.hpp"

namespace aims {

/// The medians of the first, the middle and the last third; there are three values or more.
inline std::array<Duration, 3> medians_of_thirds(const std::vector<Duration>& series) {
  const std::size_t third = series.size() / 3;
  std::array<Duration, 3> medians{};
  for (std::size_t i = 0; i < medians.size(); ++i) {
    const auto begin = series.begin() + static_cast<std::ptrdiff_t>(i * third);
    medians[i] =
        *upper_median(std::vector<Duration>(begin, begin + static_cast<std::ptrdiff_t>(third)));
  }
  return medians;
}

/// By how much a series grows from its first third to its last.
struct SeriesGrowth {
  Duration grown = 0;
  Duration uneven = 0;  ///< by how much that differs between its halves

  explicit SeriesGrowth(const std::array<Duration, 3>& medians)
      : grown(medians[2] - medians[0]),
        uneven(std::abs(medians[2] - 2 * medians[1] + medians[0])) {}
  bool is_even() const { return 4 * uneven <= std::abs(grown); }
};

/// A leap of a series.
struct SeriesLeap {
  std::size_t at = 0;               ///< the first value behind it
  Duration before = 0, behind = 0;  ///< medians
  std::size_t strays = 0;           ///< values that are not near the median of their side

  Duration step() const { return behind - before; }
};

/// The largest step of a series that lies at least `margin` values from its ends and is larger than
/// `least`; `tolerance`, of the step: how near values are to the medians.
template <class Tolerance>
std::optional<SeriesLeap> largest_leap(const std::vector<Duration>& series, std::size_t margin,
                                       Duration least, const Tolerance& tolerance) {
  SeriesLeap leap;
  Duration largest = least;
  for (std::size_t i = margin; i + margin <= series.size(); ++i) {
    const Duration step = std::abs(series[i] - series[i - 1]);
    if (step <= largest) continue;
    largest = step;
    leap.at = i;
  }
  if (leap.at == 0) return std::nullopt;
  const auto middle = series.begin() + static_cast<std::ptrdiff_t>(leap.at);
  leap.before = *upper_median(std::vector<Duration>(series.begin(), middle));
  leap.behind = *upper_median(std::vector<Duration>(middle, series.end()));
  const Duration near = tolerance(std::abs(leap.step()));
  for (std::size_t i = 0; i < series.size(); ++i) {
    const Duration usual = i < leap.at ? leap.before : leap.behind;
    leap.strays += std::abs(series[i] - usual) > near ? 1 : 0;
  }
  return leap;
}

}  // namespace aims
