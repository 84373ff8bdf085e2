// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/feature_solver.hpp"

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <optional>

#include "core/angle.hpp"
#include "estimator/baselines/features/huber_problem.hpp"

namespace aims::features {
namespace {

/// A^T A and A^T d of weighted distances.
struct NormalEquations {
  Matrix6 AtA = Matrix6::Zero();
  Vector6 Atd = Vector6::Zero();
  int rows = 0;

  void add(const DistanceRow& row, double weight) {
    const Vector6 a = weight * row.jacobian();
    AtA += a * a.transpose();
    Atd += a * (weight * row.distance);
    ++rows;
  }
};

NormalEquations weighted_equations(const FeatureMatches& matches, const Pose& pose,
                                   const SolverConfig& config, bool weighted) {
  NormalEquations equations;
  const DistanceWeight weighting{weighted ? config.weight_slope : 0.0, config.min_weight};
  weighted_distances(matches, pose, weighting,
                     [&](const Eigen::Vector3d&, const DistanceRow& row, double weight) {
                       equations.add(row, weight);
                     });
  return equations;
}

SolverResult gauss_newton(const Pose& initial, const Associate& associate,
                          const SolverConfig& config, const PoseCoordinates& coordinates) {
  SolverResult result;
  result.pose = initial;
  FeatureMatches matches;
  for (int i = 0; i < config.max_iterations; ++i) {
    if (i % config.association_interval == 0) matches = associate(result.pose);
    const NormalEquations equations =
        weighted_equations(matches, result.pose, config, i >= config.unweighted_iterations);
    if (equations.rows < config.min_matches) break;
    const Eigen::MatrixXd AtA = equations.AtA(coordinates, coordinates);
    Eigen::VectorXd free_step =
        AtA.colPivHouseholderQr().solve((-config.residual_factor * equations.Atd)(coordinates));
    if (i == 0) result.directions = constrained_directions(AtA, config.remap_threshold);
    if (result.directions.removed > 0) free_step = result.directions.projection * free_step;
    if (!free_step.allFinite()) break;
    Vector6 step = Vector6::Zero();
    step(coordinates) = free_step;
    result.pose = moved(result.pose, step);
    result.iterations = i + 1;
    if (step.head<3>().norm() < kRadiansPerDegree * config.stop_rotation_deg &&
        step.tail<3>().norm() < config.stop_position) {
      break;
    }
  }
  result.lines = static_cast<int>(matches.lines.size());
  result.planes = static_cast<int>(matches.planes.size());
  return result;
}

SolverResult levenberg_marquardt(const Pose& initial, const Associate& associate,
                                 const SolverConfig& config) {
  SolverResult result;
  result.pose = initial;
  for (int done = 0; done < config.max_iterations; done += config.association_interval) {
    const FeatureMatches matches = associate(result.pose);
    result.lines = static_cast<int>(matches.lines.size());
    result.planes = static_cast<int>(matches.planes.size());
    if (matches.size() == 0) break;
    const HuberProblem problem(matches, config.huber);
    if (done == 0) {
      result.directions = constrained_directions(problem.linearized(result.pose).information, 0.0);
      result.directions.removed = 0;
    }
    const int rest = config.max_iterations - done;
    const auto [pose, iterations] =
        minimize(problem, result.pose, std::min(rest, config.association_interval));
    result.pose = pose;
    result.iterations += iterations;
  }
  return result;
}

}  // namespace

SolverConfig map_solver_config() {
  SolverConfig config;
  config.max_iterations = 10;
  config.association_interval = 1;
  config.residual_factor = 1.0;
  config.unweighted_iterations = 0;
  config.weight_slope = 0.9;
  config.min_matches = 50;
  config.remap_threshold = 100.0;
  config.stop_rotation_deg = 0.05;
  config.stop_position = 0.0005;
  return config;
}

void describe(Fields& f, SolverConfig& c) {
  f.choice("method", c.method,
           {{"gauss_newton", SolverMethod::kGaussNewton},
            {"levenberg_marquardt", SolverMethod::kLevenbergMarquardt}},
           {"", any(), "how the pose is found", "LOAM; A-LOAM"});
  f.integer("max_iterations", c.max_iterations, {"-", in_range(1, 1000), "iterations at most"});
  f.integer("association_interval", c.association_interval,
            {"-", in_range(1, 1000), "iterations for which the matches stay"});
  f.number("residual_factor", c.residual_factor,
           {"-", in_range(1e-3, 1.0), "part of the residuals that a step removes"});
  f.integer("unweighted_iterations", c.unweighted_iterations,
            {"-", in_range(0, 1000), "first iterations, in which each weight is 1"});
  f.number("weight_slope", c.weight_slope,
           {"1/m", up_to(1e4), "weight = 1 - slope |d|, for planes |d| / sqrt(range)"});
  f.number("min_weight", c.min_weight,
           {"-", in_range(0.0, 0.99), "residuals of less weight are left out"});
  f.integer("min_matches", c.min_matches, {"-", in_range(6, 100000), "needed for a step"});
  f.number("remap_threshold", c.remap_threshold,
           {"-", up_to(1e9), "directions with a smaller eigenvalue of A^T A do not move",
            "Zhang, Kaess and Singh, ICRA 2016"});
  f.number("stop_rotation_deg", c.stop_rotation_deg,
           {"deg", up_to(180.0), "smaller steps end the iteration"});
  f.number("stop_position", c.stop_position, {"m", up_to(1e4), "smaller steps end the iteration"});
  f.number("huber", c.huber, {"m", positive_up_to(1e4), "larger distances have a linear loss"});
  f.idle_if(c.method == SolverMethod::kLevenbergMarquardt, "method is levenberg_marquardt",
            {"residual_factor", "unweighted_iterations", "weight_slope", "min_weight",
             "min_matches", "remap_threshold", "stop_rotation_deg", "stop_position"});
  f.idle_if(c.method == SolverMethod::kGaussNewton, "method is gauss_newton", {"huber"});
}

PoseCoordinates all_coordinates() { return {0, 1, 2, 3, 4, 5}; }

double smallest_eigenvalue(const SolverResult& result) {
  return result.iterations == 0 ? std::numeric_limits<double>::quiet_NaN()
                                : result.directions.smallest_eigenvalue;
}

SolverResult solve_pose(const Pose& initial, const Associate& associate, const SolverConfig& config,
                        const PoseCoordinates& coordinates) {
  return config.method == SolverMethod::kGaussNewton
             ? gauss_newton(initial, associate, config, coordinates)
             : levenberg_marquardt(initial, associate, config);
}

}  // namespace aims::features
