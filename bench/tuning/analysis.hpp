// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "bench/metrics/bootstrap.hpp"
#include "bench/tuning/objective.hpp"
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
  bool defaults_diverged = false;  ///< every run with the defaults: there is no gain
  Interval gain_interval;
  std::vector<double> distance;  ///< best minus defaults per parameter, in widths of its range
};

/// Error when no point has an objective.
Result<BestPoint> best_point(const ResponseTable& table, const Objective& objective);

}  // namespace aims
