// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

namespace aims {

/// Arithmetic mean; none of no values.
std::optional<double> mean(std::span<const double> values);

/// The value below which a `fraction` in [0, 1] of the values lies: linear between the two order
/// statistics around position fraction * (count - 1) (type 7 of Hyndman and Fan, as in numpy).
std::optional<double> quantile(std::span<const double> values, double fraction);

/// The 0.5 quantile.
std::optional<double> median(std::span<const double> values);

/// Summary of a sample of which more is worse (errors, times).
struct Summary {
  int count = 0;    ///< finite values, of which the rest is made
  int missing = 0;  ///< values that are not finite
  double mean = 0.0;
  double p50 = 0.0;  ///< median
  double p99 = 0.0;
  double worst = 0.0;  ///< largest
};

/// Summary of the finite values; none when there is none.
std::optional<Summary> summarize(std::span<const double> values);

}  // namespace aims
