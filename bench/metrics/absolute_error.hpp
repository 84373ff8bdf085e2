// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "bench/metrics/association.hpp"

namespace aims {

/// Difference of estimated and true displacement from start to end.
struct EndError {
  double norm_m = 0.0;  ///< M_end; as in the paper when the true end is the start
  double xy_m = 0.0;    ///< its horizontal part
  double z_m = 0.0;     ///< its vertical part, absolute
};

/// Root mean square of the position errors [m] of aligned pairs (evo: APE, translation part).
std::optional<double> ate_rmse(std::span<const PosePair> pairs);

/// Largest position error [m] of aligned pairs.
std::optional<double> max_error(std::span<const PosePair> pairs);

/// Largest absolute vertical error [m] of aligned pairs.
std::optional<double> max_abs_z_error(std::span<const PosePair> pairs);

/// M_end of pairs aligned at their start: the position error of the last pair.
std::optional<EndError> end_error(std::span<const PosePair> pairs);

}  // namespace aims
