// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bench/metrics/statistics.hpp"
#include "bench/tuning/objective.hpp"

namespace aims {

/// The objective at one value of one parameter, or at a pair of values.
struct SlicePoint {
  double x = 0.0;
  double y = 0.0;  ///< of the second parameter of a map
  std::optional<double> objective;
  Interval interval;  ///< 95 %: bootstrap over seeds where measured, by its error of a fit
};

/// The objective along one parameter or over two, all others held at one value each: at the
/// defaults, or where the points are a grid at its values next to them.
struct Slice {
  std::size_t first = 0;
  std::optional<std::size_t> second;
  std::string family;                ///< whose scenarios; "" for all
  std::vector<double> held;          ///< value of each parameter; of those that vary, no meaning
  std::vector<SlicePoint> measured;  ///< points that were run, by x and y
  /// Of a surrogate, without an objective where it extrapolates; empty unless cross-validation
  /// supports it (`kLeastExplained`) and the parameters that vary have at least `kFittedLevels`
  /// different values among the points.
  std::vector<SlicePoint> fit;

  bool is_empty() const { return measured.empty() && fit.empty(); }
};

/// Fewest different values of a parameter along which a fit is drawn: between fewer, leaving points
/// out tests nothing.
inline constexpr std::size_t kFittedLevels = 8;

/// One parameter's curve; empty unless there is a fit or at least two points were run on it.
Slice curve_of(const ResponseTable& table, const Objective& objective, std::size_t parameter,
               const std::string& family = "");

/// The map over two parameters: measured where the points have a grid over both, else fitted.
Slice map_of(const ResponseTable& table, const Objective& objective, std::size_t first,
             std::size_t second, const std::string& family = "");

/// "kappa = 10 (default 12.6), alpha = 0.9": what a slice holds the other parameters at; empty
/// where it varies all.
std::string held_text(const ResponseTable& table, const Slice& slice);

}  // namespace aims
