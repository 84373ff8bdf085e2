// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/feature_solver.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/angle.hpp"

namespace aims::features {

ConstrainedDirections constrained_directions(const Eigen::MatrixXd& AtA, double threshold) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(AtA);
  ConstrainedDirections directions;
  directions.projection = Eigen::MatrixXd::Identity(AtA.rows(), AtA.cols());
  directions.smallest_eigenvalue = solver.eigenvalues()[0];
  for (Eigen::Index i = 0; i < AtA.rows(); ++i) {
    if (solver.eigenvalues()[i] >= threshold) continue;
    const Eigen::VectorXd free_direction = solver.eigenvectors().col(i);
    directions.projection -= free_direction * free_direction.transpose();
    ++directions.removed;
  }
  return directions;
}

namespace {

// Defaults of the Ceres solver, ceres::Solver::Options.
constexpr double kInitialRadius = 1e4;
constexpr double kMaxRadius = 1e16;
constexpr double kMinDiagonal = 1e-6;
constexpr double kMaxDiagonal = 1e32;
constexpr double kMinRelativeDecrease = 1e-3;
constexpr double kFunctionTolerance = 1e-6;
constexpr double kGradientTolerance = 1e-10;
constexpr double kParameterTolerance = 1e-8;

double huber_loss(double squared, double delta) {
  return squared <= delta * delta ? squared : 2.0 * delta * std::sqrt(squared) - delta * delta;
}

/// Derivative of the loss in the squared distance: the weight of a residual.
double huber_weight(double squared, double delta) {
  return squared <= delta * delta ? 1.0 : delta / std::sqrt(squared);
}

void add_row(const DistanceRow& row, const Eigen::Vector3d& gradient, double fraction,
             double distance, double weight, HuberProblem::Linearized& sum) {
  Vector6 jacobian;
  jacobian << row.arm.cross(gradient), gradient;
  jacobian *= fraction;
  sum.information += weight * jacobian * jacobian.transpose();
  sum.gradient += weight * distance * jacobian;
}

/// Steps of the trust region: grows after a good step, shrinks faster with each bad one.
class TrustRegion {
 public:
  double radius() const { return radius_; }
  void accepted(double quality) {
    radius_ =
        std::min(kMaxRadius, radius_ / std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * quality - 1.0, 3)));
    divisor_ = 2.0;
  }
  void rejected() {
    radius_ /= divisor_;
    divisor_ *= 2.0;
  }

 private:
  double radius_ = kInitialRadius;
  double divisor_ = 2.0;
};

}  // namespace

double HuberProblem::cost(const Pose& pose) const {
  double sum = 0.0;
  const auto add = [&](double distance) { sum += huber_loss(distance * distance, delta_); };
  for (const LineMatch& match : matches_.lines) add(distance_row(match, pose).distance);
  for (const PlaneMatch& match : matches_.planes) add(distance_row(match, pose).distance);
  return sum / 2.0;
}

HuberProblem::Linearized HuberProblem::linearized(const Pose& pose) const {
  Linearized sum;
  for (const LineMatch& match : matches_.lines) {
    const DistanceRow row = distance_row(match, pose);
    const double squared = row.distance * row.distance;
    const double weight = huber_weight(squared, delta_);
    const Eigen::Vector3d first = match.direction.unitOrthogonal();
    const Eigen::Vector3d second = match.direction.cross(first);
    const Eigen::Vector3d across = row.distance * row.gradient;
    add_row(row, first, match.fraction, first.dot(across), weight, sum);
    add_row(row, second, match.fraction, second.dot(across), weight, sum);
    sum.cost += huber_loss(squared, delta_) / 2.0;
  }
  for (const PlaneMatch& match : matches_.planes) {
    const DistanceRow row = distance_row(match, pose);
    const double squared = row.distance * row.distance;
    add_row(row, row.gradient, match.fraction, row.distance, huber_weight(squared, delta_), sum);
    sum.cost += huber_loss(squared, delta_) / 2.0;
  }
  return sum;
}

Minimum minimize(const HuberProblem& problem, const Pose& initial, int max_iterations) {
  Minimum minimum{initial};
  HuberProblem::Linearized at = problem.linearized(initial);
  const Vector6 scale = (1.0 + at.information.diagonal().array().sqrt()).inverse();
  TrustRegion region;
  while (minimum.iterations < max_iterations) {
    if (at.gradient.cwiseAbs().maxCoeff() <= kGradientTolerance) break;
    ++minimum.iterations;
    const Matrix6 scaled = scale.asDiagonal() * at.information * scale.asDiagonal();
    const Vector6 gradient = scale.cwiseProduct(at.gradient);
    const Vector6 damping =
        scaled.diagonal().cwiseMax(kMinDiagonal).cwiseMin(kMaxDiagonal) / region.radius();
    const Matrix6 damped = scaled + Matrix6(damping.asDiagonal());
    const Vector6 step = -damped.ldlt().solve(gradient);
    const double predicted = -step.dot(gradient) - step.dot(scaled * step) / 2.0;
    const Pose candidate = moved(minimum.pose, scale.cwiseProduct(step));
    const double change = at.cost - problem.cost(candidate);
    const double size = minimum.pose.translation.norm() + 1.0;  // of position and quaternion
    if (scale.cwiseProduct(step).norm() <= kParameterTolerance * size) break;
    if (!(predicted > 0.0) || !(change / predicted > kMinRelativeDecrease)) {
      region.rejected();
      continue;
    }
    const bool done = std::abs(change) < kFunctionTolerance * at.cost;
    minimum.pose = candidate;
    region.accepted(change / predicted);
    if (done) break;
    at = problem.linearized(candidate);
  }
  return minimum;
}

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
