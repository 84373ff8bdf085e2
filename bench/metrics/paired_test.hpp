// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "bench/metrics/statistics.hpp"

namespace aims {

/// Fewest pairs with which the sign-flip test can reach the level of 5 %: 2 / 2^6 = 0.031.
inline constexpr std::size_t kFewestPairs = 6;

/// What differences of pairs say of a change. Test and interval are one rule: p <= 0.05 exactly
/// when the interval excludes zero.
struct PairedTest {
  double change = 0.0;  ///< mean of the differences
  double p = 1.0;       ///< two-sided
  Interval interval;    ///< 95 %, of the change; empty below kFewestPairs
  /// Smallest change that would have been found with this scatter; none below kFewestPairs.
  std::optional<double> detectable;

  bool found() const { return interval.low && (*interval.low > 0.0 || *interval.high < 0.0); }
};

/// The sign-flip test of the mean (Fisher 1935). Without a change each difference could as well
/// have the other sign; p counts how many of the 2^n choices of signs give a mean as far from zero.
/// Its inversion is the interval between means of subsets of the differences (Hartigan 1969). It
/// covers the true change with 95 % or a little more for differences that are independent and
/// symmetric about it, of any distribution and with few pairs. Above 13 pairs 8191 of the choices
/// are drawn at random, always the same.
PairedTest paired_test(std::span<const double> differences);

/// The smallest p that this test can give with so many pairs: 2 / 2^n.
double smallest_p(std::size_t pairs);

/// Probability that differences of these sizes and random signs pass the test with a mean of more
/// than `floor`.
double false_alarm_rate(std::span<const double> differences, double floor);

}  // namespace aims
