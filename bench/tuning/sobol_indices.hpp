// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "bench/metrics/statistics.hpp"

namespace aims {

/// Fractions of the variance of a function whose inputs are independent and uniform in their ranges
/// (I. M. Sobol, 2001).
struct SobolIndices {
  std::vector<double> first;  ///< of each input alone
  std::vector<double> total;  ///< of each input with all its interactions
  Eigen::MatrixXd second;     ///< of each pair beyond both alone; symmetric, zero diagonal
  std::vector<Interval> total_interval;  ///< 95 %; empty where the data do not determine it
};

/// The indices of `values` at `points` (a row each) that form a complete grid, every combination of
/// the inputs' levels the same number of times: an analysis of variance in which each level has the
/// same weight, exact and without a model. Without intervals. None for points that are no such grid
/// or have one level alone, and for sizes that do not fit.
std::optional<SobolIndices> grid_indices(const Eigen::MatrixXd& points,
                                         const Eigen::VectorXd& values);

/// Indices of a part of a grid, e.g. one whose jobs are not all done or a fractional factorial.
struct FractionalIndices {
  SobolIndices indices;    ///< every level with the same weight
  double explained = 0.0;  ///< R^2 of each point from the others (leave one out)
  bool with_pairs = false;
};

/// An analysis of variance by least squares: an effect of each level of each input, and of each
/// pair of levels where the points determine them and predict better with them. None for inputs
/// with fewer than two points per level (those are no grid), or too few points for the effects.
std::optional<FractionalIndices> fractional_indices(const Eigen::MatrixXd& points,
                                                    const Eigen::VectorXd& values);

}  // namespace aims
