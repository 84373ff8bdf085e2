// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bench/metrics/bootstrap.hpp"
#include "bench/tuning/objective.hpp"
#include "bench/tuning/surrogate.hpp"
#include "core/error.hpp"

namespace aims {

/// The best of the points that were run, with 95 % bootstrap intervals over seeds, each resampled
/// with all its scenarios. They are empty for one seed, and too narrow for a few.
struct BestPoint {
  std::size_t point = 0;
  std::vector<double> values;     ///< of each parameter
  std::vector<Interval> between;  ///< of each parameter: interval of the best value
  double objective = 0.0;
  Interval objective_interval;
  std::optional<double> defaults;  ///< objective of the default setting
  std::optional<double> gain;      ///< reduction of the objective, as a fraction of the defaults'
  Interval gain_interval;
  std::vector<double> distance;  ///< best minus defaults per parameter, in widths of its range
};

/// Error when no point has an objective.
Result<BestPoint> best_point(const ResponseTable& table, const Objective& objective);

/// Global sensitivity of the objective, by a surrogate of its logarithm (of itself where it can be
/// zero).
struct Sensitivity {
  std::size_t points = 0;   ///< that have an objective
  bool logarithmic = true;  ///< the indices are of the logarithm
  Surrogate surrogate;

  /// True when the surrogate explains at least half of the variance; below, its indices mean
  /// little.
  bool is_reliable() const { return surrogate.explained() >= 0.5; }
  /// True of a parameter whose total index is below 5 % with its entire interval; never of an
  /// unreliable surrogate.
  bool is_negligible(std::size_t parameter) const;
};

/// Error for fewer points than a surrogate needs. With `family` over its scenarios alone.
Result<Sensitivity> sensitivity_of(const ResponseTable& table, const Objective& objective,
                                   const std::string& family = "");

/// The objective at one value of one parameter, or at a pair of values.
struct SlicePoint {
  double x = 0.0;
  double y = 0.0;  ///< of the second parameter of a map
  std::optional<double> objective;
  Interval interval;  ///< 95 %: bootstrap over seeds where measured, else by the surrogate's error
};

/// The objective along one parameter or over two, all others at the defaults (or at the grid's
/// values next to them).
struct Slice {
  std::size_t first = 0;
  std::optional<std::size_t> second;
  std::string family;     ///< whose scenarios; "" for all
  bool measured = false;  ///< else predicted by the surrogate
  std::vector<SlicePoint> points;
};

/// One parameter's curve: from points of the design where at least three lie on it, else from the
/// surrogate where it is reliable, without an objective where it extrapolates; else without
/// points.
Slice curve_of(const ResponseTable& table, const Objective& objective, std::size_t parameter,
               const std::string& family = "");

/// The map over two parameters, likewise; measured where the design has a grid of at least 3 by 3.
Slice map_of(const ResponseTable& table, const Objective& objective, std::size_t first,
             std::size_t second, const std::string& family = "");

}  // namespace aims
