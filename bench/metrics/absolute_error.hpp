// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bench/metrics/alignment.hpp"
#include "bench/metrics/association.hpp"

namespace aims {

/// Difference of estimated and true displacement from start to end.
struct EndError {
  double norm_m = 0.0;  ///< M_end; as in the paper when the true end is the start
  double xy_m = 0.0;    ///< its horizontal part
  double z_m = 0.0;     ///< its vertical part, absolute
};

/// Position errors of aligned pairs (evo: APE, translation part) [m].
struct AbsoluteErrorStatistics {
  double mean_m = 0.0;
  double median_m = 0.0;
  double std_m = 0.0;  ///< about the mean, over their number (numpy.std)
  double min_m = 0.0;
  double max_m = 0.0;
};

// Pairs are aligned, or are so by `alignment`, which spares a copy of them.

/// None without pairs.
std::optional<AbsoluteErrorStatistics> absolute_error_statistics(
    std::span<const PosePair> pairs, const std::optional<Alignment>& alignment = {});

/// Position error of each of aligned pairs [m].
std::vector<double> position_errors(std::span<const PosePair> pairs,
                                    const std::optional<Alignment>& alignment = {});

/// Root mean square of the heading errors [rad] of aligned pairs; the rotation error is taken in
/// the frame of the truth, whose z is along gravity.
std::optional<double> heading_rmse(std::span<const PosePair> pairs,
                                   const std::optional<Alignment>& alignment = {});

/// Root mean square of the position errors [m] of aligned pairs (evo: APE, translation part).
std::optional<double> ate_rmse(std::span<const PosePair> pairs,
                               const std::optional<Alignment>& alignment = {});

/// Largest position error [m] of aligned pairs.
std::optional<double> max_error(std::span<const PosePair> pairs);

/// Largest absolute vertical error [m] of aligned pairs.
std::optional<double> max_abs_z_error(std::span<const PosePair> pairs);

/// M_end of pairs aligned at their start: the position error of the last pair.
std::optional<EndError> end_error(std::span<const PosePair> pairs);

}  // namespace aims
