// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/optimizer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <map>
#include <memory>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/de.hpp>
#include <pagmo/algorithms/nsga2.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <utility>

#include "bench/tuning/design.hpp"

namespace aims {
namespace {

constexpr double kConverged = 1e-3;

/// Objectives of the points evaluated so far, shared by all copies of the problem.
struct Evaluations {
  std::map<std::vector<double>, std::vector<double>> values;
  Points missing;  ///< requested and not evaluated
};

/// pagmo's problem: looks values up. A point without a value is noted and given zeros: pagmo
/// requests the points of a generation one by one, so each generation first runs on a copy to
/// collect its points, which do not depend on one another's values.
struct LookUp {
  std::shared_ptr<Evaluations> evaluations;
  std::size_t inputs = 1;
  std::size_t objectives = 1;

  pagmo::vector_double fitness(const pagmo::vector_double& point) const {
    const auto found = evaluations->values.find(point);
    if (found != evaluations->values.end()) return found->second;
    if (std::find(evaluations->missing.begin(), evaluations->missing.end(), point) ==
        evaluations->missing.end()) {
      evaluations->missing.push_back(point);
    }
    return pagmo::vector_double(objectives, 0.0);
  }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {pagmo::vector_double(inputs, 0.0), pagmo::vector_double(inputs, 1.0)};
  }
  pagmo::vector_double::size_type get_nobj() const { return objectives; }
};

OptimizerKind kind_of(const OptimizerOptions& options, std::size_t objectives) {
  if (options.kind != OptimizerKind::kAuto) return options.kind;
  return objectives > 1 ? OptimizerKind::kNsga2 : OptimizerKind::kCmaes;
}

/// One generation per call of evolve.
pagmo::algorithm algorithm_of(const OptimizerOptions& options, std::size_t objectives) {
  const auto seed = static_cast<unsigned>(options.seed);
  switch (kind_of(options, objectives)) {
    case OptimizerKind::kDe:
      return pagmo::algorithm(pagmo::de(1, 0.8, 0.9, 2, 0.0, 0.0, seed));
    case OptimizerKind::kNsga2:
      return pagmo::algorithm(
          pagmo::nsga2(1, 0.95, 10.0, 1.0 / static_cast<double>(options.population), 20.0, seed));
    default:
      return pagmo::algorithm(
          pagmo::cmaes(1, -1, -1, -1, -1, options.step, 0.0, 0.0, true, true, seed));
  }
}

Points first_population(const std::vector<double>& start, const OptimizerOptions& options) {
  const std::vector<ParameterRange> cube(start.size(), {"", 0.0, 1.0, 0, false});
  Points points = {start};
  if (options.population > 1) {
    const auto others = design(DesignKind::kSobol, cube, options.population - 1,
                               static_cast<std::uint64_t>(options.seed));
    points.insert(points.end(), others.begin(), others.end());
  }
  return points;
}

class Optimization {
 public:
  Optimization(const BatchFunction& function, std::size_t inputs, std::size_t objectives,
               const OptimizerOptions& options)
      : function_(function),
        options_(options),
        problem_(LookUp{evaluations_, inputs, objectives}),
        algorithm_(algorithm_of(options, objectives)) {}

  Result<OptimizerRun> run(const std::vector<double>& start) {
    const Points first = first_population(start, options_);
    if (auto known = add_values(first, 0); !known) return tl::unexpected(known.error());
    if (!run_.complete) return std::move(run_);
    pagmo::population population(problem_, 0, static_cast<unsigned>(options_.seed));
    for (const auto& point : first) population.push_back(point, evaluations_->values.at(point));
    for (int generation = 1; generation <= options_.generations; ++generation) {
      if (auto evolved = evolve(population, generation); !evolved) {
        return tl::unexpected(evolved.error());
      }
      if (!run_.complete) break;
      run_.converged = width(population) < kConverged;
      if (run_.converged) break;
    }
    return std::move(run_);
  }

 private:
  /// Evolves a copy until every point of the generation has a value, then keeps it.
  Result<void> evolve(pagmo::population& population, int generation) {
    while (true) {
      pagmo::algorithm copy = algorithm_;
      pagmo::population next = copy.evolve(population);
      if (evaluations_->missing.empty()) {
        algorithm_ = std::move(copy);
        population = std::move(next);
        return {};
      }
      const Points missing = std::exchange(evaluations_->missing, {});
      if (auto known = add_values(missing, generation); !known) return known;
      if (!run_.complete) return {};
    }
  }

  Result<void> add_values(const Points& points, int generation) {
    const auto objectives = function_(points);
    if (!objectives) return tl::unexpected(objectives.error());
    run_.complete = objectives->has_value();
    if (!run_.complete) return {};
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (!evaluations_->values.emplace(points[k], (**objectives)[k]).second) continue;
      run_.points.push_back(points[k]);
      run_.objectives.push_back((**objectives)[k]);
      run_.generation.push_back(generation);
    }
    return {};
  }

  /// Largest extent of a population in any input.
  static double width(const pagmo::population& population) {
    double widest = 0.0;
    const auto& points = population.get_x();
    for (std::size_t i = 0; i < points.front().size(); ++i) {
      const auto [low, high] = std::minmax_element(
          points.begin(), points.end(), [i](const auto& a, const auto& b) { return a[i] < b[i]; });
      widest = std::max(widest, (*high)[i] - (*low)[i]);
    }
    return widest;
  }

  const BatchFunction& function_;
  const OptimizerOptions& options_;
  std::shared_ptr<Evaluations> evaluations_ = std::make_shared<Evaluations>();
  pagmo::problem problem_;
  pagmo::algorithm algorithm_;
  OptimizerRun run_;
};

}  // namespace

Result<void> check_optimizer(const OptimizerOptions& options, std::size_t objectives) {
  const OptimizerKind kind = kind_of(options, objectives);
  if (objectives < 1) return failure("objectives: expected at least one");
  if (objectives > 1 && kind != OptimizerKind::kNsga2) {
    return failure(fmt::format("algorithm: {} objectives need nsga2 (or auto); the others take one",
                               objectives));
  }
  if (objectives == 1 && kind == OptimizerKind::kNsga2) {
    return failure("algorithm: nsga2 needs at least two objectives; for one, expected cmaes or de");
  }
  if (options.population < 5) {
    return failure(fmt::format("population {}: expected at least 5", options.population));
  }
  if (kind == OptimizerKind::kNsga2 && (options.population < 8 || options.population % 4 != 0)) {
    return failure(fmt::format("population {}: nsga2 expects a multiple of 4, at least 8",
                               options.population));
  }
  return {};
}

Result<OptimizerRun> minimize(const BatchFunction& function, const std::vector<double>& start,
                              std::size_t objectives, const OptimizerOptions& options) {
  if (auto checked = check_optimizer(options, objectives); !checked) {
    return tl::unexpected(checked.error());
  }
  try {
    return Optimization(function, start.size(), objectives, options).run(start);
  } catch (const std::exception& error) {  // of pagmo
    return failure(fmt::format("optimization: {}", error.what()));
  }
}

std::vector<std::size_t> pareto_front(const Points& objectives) {
  const auto dominates = [&](std::size_t a, std::size_t b) {
    bool better = false;
    for (std::size_t i = 0; i < objectives[a].size(); ++i) {
      if (objectives[a][i] > objectives[b][i]) return false;
      better = better || objectives[a][i] < objectives[b][i];
    }
    return better;
  };
  std::vector<std::size_t> front;
  for (std::size_t k = 0; k < objectives.size(); ++k) {
    bool beaten = false;
    for (std::size_t other = 0; other < objectives.size() && !beaten; ++other) {
      beaten = dominates(other, k) || (other < k && objectives[other] == objectives[k]);
    }
    if (!beaten) front.push_back(k);
  }
  std::stable_sort(front.begin(), front.end(),
                   [&](std::size_t a, std::size_t b) { return objectives[a] < objectives[b]; });
  return front;
}

}  // namespace aims
