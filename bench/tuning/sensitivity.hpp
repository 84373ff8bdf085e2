// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bench/tuning/effect.hpp"
#include "bench/tuning/objective.hpp"
#include "bench/tuning/sobol_indices.hpp"
#include "bench/tuning/surrogate.hpp"
#include "core/error.hpp"

namespace aims {

/// The cross-validated R^2 from which on a surrogate, or the effects of a part of a grid, support
/// indices, and a surrogate curves.
inline constexpr double kLeastExplained = 0.9;

/// Why there are no indices of a single parameter.
std::string why_no_indices_of_one(const Effect& effect);

/// Global sensitivity of the logarithm of the objective (of itself where it can be zero): from the
/// points themselves where they form a grid or a part of one, else from a surrogate.
struct Sensitivity {
  std::size_t points = 0;   ///< that have an objective
  bool logarithmic = true;  ///< the indices are of the logarithm
  bool of_grid = false;     ///< an analysis of variance of the grid, with intervals over seeds
  /// Of a part of a grid, whose effects support the indices; without intervals.
  std::optional<FractionalIndices> of_part;
  SobolIndices indices;
  std::optional<Surrogate> surrogate;  ///< none through too few points
  Effect effect;                       ///< of all parameters together

  /// True when the surrogate's cross-validated R^2 is at least `kLeastExplained`.
  bool is_fitted() const { return surrogate && surrogate->explained() >= kLeastExplained; }
  /// Of a grid, a part of one, or a surrogate that fits.
  bool has_indices() const { return of_grid || of_part || is_fitted(); }
  /// True when they mean something: there is an effect beyond the scatter of seeds, and not of one
  /// worse point alone.
  bool is_resolved() const { return has_indices() && effect.tells_best(); }
  /// True of a parameter whose total index is below 5 % with its entire interval; never where the
  /// indices are not resolved.
  bool is_negligible(std::size_t parameter) const;
};

/// Error for points that are neither a grid nor as many as a surrogate needs. With `family` over
/// its scenarios alone.
Result<Sensitivity> sensitivity_of(const ResponseTable& table, const Objective& objective,
                                   const std::string& family = "");

/// Where a point lies in each parameter's range, in [0, 1].
Eigen::VectorXd fractions_of(const ResponseTable& table, const std::vector<double>& values);

}  // namespace aims
