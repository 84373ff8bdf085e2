// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "core/config.hpp"
#include "estimator/baselines/features/feature_matches.hpp"

namespace aims::features {

/// Which directions of the state the residuals constrain (Zhang, Kaess and Singh, "On degeneracy of
/// optimization-based state estimation problems", ICRA 2016): those eigenvectors of A^T A whose
/// eigenvalue reaches a threshold.
struct ConstrainedDirections {
  Eigen::MatrixXd projection;        ///< V_kept V_kept^T, onto the constrained directions
  int removed = 0;                   ///< directions below the threshold
  double smallest_eigenvalue = 0.0;  ///< of A^T A
};

/// The constrained directions of the information `AtA`, a symmetric matrix of any size.
ConstrainedDirections constrained_directions(const Eigen::MatrixXd& AtA, double threshold);

/// Sum of Huber's loss over the distances of matched points from their lines and planes.
class HuberProblem {
 public:
  /// The loss of a distance is quadratic up to `delta` [m], then linear.
  HuberProblem(const FeatureMatches& matches, double delta) : matches_(matches), delta_(delta) {}

  /// The problem around a pose, with the weight of each residual fixed.
  struct Linearized {
    double cost = 0.0;                      ///< half the sum of the losses [m^2]
    Matrix6 information = Matrix6::Zero();  ///< J^T J, rotation then position
    Vector6 gradient = Vector6::Zero();     ///< J^T r
  };

  double cost(const Pose& pose) const;
  Linearized linearized(const Pose& pose) const;

 private:
  const FeatureMatches& matches_;
  double delta_;
};

struct Minimum {
  Pose pose;
  int iterations = 0;
};

/// Levenberg and Marquardt's method with the trust region rule, the scaling of columns and the
/// tolerances that the Ceres solver has by default, at most `max_iterations`.
Minimum minimize(const HuberProblem& problem, const Pose& initial, int max_iterations);

/// How the pose is found from the distances of the matched points.
enum class SolverMethod {
  kGaussNewton,         ///< LOAM: weighted rows, without the directions that are degenerate
  kLevenbergMarquardt,  ///< A-LOAM: Huber's loss, damped steps
};

/// Settings of the search for a pose; defaults: LOAM's between two scans.
struct SolverConfig {
  SolverMethod method = SolverMethod::kGaussNewton;
  int max_iterations = 25;
  int association_interval = 5;    ///< iterations for which the matches stay
  double residual_factor = 0.05;   ///< part of the residuals that a step removes
  int unweighted_iterations = 5;   ///< first iterations, in which each weight is 1
  double weight_slope = 1.8;       ///< weight = 1 - slope |d|, of a plane |d| / sqrt(range) [1/m]
  double min_weight = 0.1;         ///< residuals of less weight are left out
  int min_matches = 10;            ///< needed for a step
  double remap_threshold = 10.0;   ///< directions of a smaller eigenvalue of A^T A do not move
  double stop_rotation_deg = 0.1;  ///< smaller steps end the iteration [deg]
  double stop_position = 0.001;    ///< [m]
  double huber = 0.1;              ///< distance from which the loss is linear [m]
};

/// LOAM's settings against the map.
SolverConfig map_solver_config();

void describe(Fields& fields, SolverConfig& config);

/// Coordinates of a pose that a solver may move: rotation 0 to 2, position 3 to 5, target axes.
using PoseCoordinates = std::vector<int>;

/// All six.
PoseCoordinates all_coordinates();

/// What a solver found.
struct SolverResult {
  Pose pose;           ///< T_target_scan
  int iterations = 0;  ///< 0: too few matches
  int lines = 0;       ///< in the last association
  int planes = 0;
  /// Of the first iteration. `removed` counts where the method removes directions.
  ConstrainedDirections directions;
};

/// Smallest eigenvalue of A^T A in the first iteration; NaN without one.
double smallest_eigenvalue(const SolverResult& result);

/// Finds the matches at a pose T_target_scan.
using Associate = std::function<FeatureMatches(const Pose&)>;

/// The pose near `initial` that minimizes the distances of the matched points.
SolverResult solve_pose(const Pose& initial, const Associate& associate, const SolverConfig& config,
                        const PoseCoordinates& coordinates = all_coordinates());

}  // namespace aims::features
