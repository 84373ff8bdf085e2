// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// Optimization algorithms, all of pagmo.
enum class OptimizerKind {
  kAuto,   ///< CMA-ES for one objective, NSGA-II for several
  kCmaes,  ///< covariance matrix adaptation (Hansen 2006)
  kDe,     ///< differential evolution (Storn and Price 1997)
  kNsga2,  ///< Pareto front of several objectives (Deb et al. 2002)
};

struct OptimizerOptions {
  OptimizerKind kind = OptimizerKind::kAuto;
  int generations = 20;  ///< after the first population
  int population = 8;    ///< points of a generation; at least 5, of NSGA-II a multiple of 4
  double step = 0.25;    ///< first standard deviation of CMA-ES, in widths of the ranges
  int seed = 1;
};

using Points = std::vector<std::vector<double>>;

/// The objectives of points of the unit cube: a row per point. No value ends the optimization with
/// what there is (an interruption); so does an error, which is returned.
using BatchFunction = std::function<Result<std::optional<Points>>(const Points&)>;

/// Every point that was evaluated, in order; none twice.
struct OptimizerRun {
  Points points;
  Points objectives;
  std::vector<int> generation;  ///< of each point, 0 = the first population
  bool complete = true;         ///< false when the function ended the run
  bool converged = false;       ///< ended early: a generation lay within 0.1 % of the ranges
};

/// Error for a population or a kind that does not fit.
Result<void> check_optimizer(const OptimizerOptions& options, std::size_t objectives);

/// Minimizes the objectives over the unit cube. The first population is
/// `start` and a Sobol sequence. A generation is evaluated in one call, so that its points can run
/// in parallel. Same seed, same points.
Result<OptimizerRun> minimize(const BatchFunction& function, const std::vector<double>& start,
                              std::size_t objectives, const OptimizerOptions& options);

/// Indices of the points that no other is better than in every objective, by the first objective.
std::vector<std::size_t> pareto_front(const Points& objectives);

}  // namespace aims
