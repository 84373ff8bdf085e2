// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "core/config.hpp"
#include "estimator/baselines/features/feature_matches.hpp"
#include "estimator/baselines/lins/state.hpp"

namespace aims::lins {

/// The iterated update (LINS, section III-C).
struct UpdateConfig {
  double deviation = 0.01;  ///< of a weighted distance [m]
  int max_iterations = 30;
  int association_interval = 1;    ///< iterations for which matches stay; before them weights are 1
  double weight_slope = 1.8;       ///< weight = 1 - slope |d|, of a plane |d| / sqrt(range) [1/m]
  double min_weight = 0.1;         ///< distances of less weight are left out
  double convergence = 0.01;       ///< norm of a step that ends the update [-]
  double divergence_ratio = 10.0;  ///< growth of the norm of the distances that is a divergence
};

void describe(Fields& fields, UpdateConfig& config);

/// Weighted distances d and their derivatives H in position and rotation, summed.
struct Distances {
  Matrix6 HtH = Matrix6::Zero();
  Vector6 Htd = Vector6::Zero();
  double squared_norm = 0.0;  ///< of d [m^2]
  int lines = 0;
  int planes = 0;
  std::vector<Eigen::Vector3d> gradients;  ///< unit, of each distance in its point
};

/// Derivative of a distance in position and rotation of the motion, as the published program has
/// it: with the whole motion whatever the firing time, times the inverse right Jacobian of the
/// rotation.
Vector6 distance_jacobian(const Eigen::Vector3d& point, const Eigen::Vector3d& gradient,
                          const Eigen::Quaterniond& rotation);

/// The distances of matched points at a motion.
Distances distances_at(const Pose& motion, const features::FeatureMatches& matches,
                       const features::DistanceWeight& weighting);

/// The distances at a state, in an iteration that counts from 0.
using DistancesAt = std::function<Distances(const State&, int iteration)>;

struct Update {
  Belief belief;  ///< the prior after a divergence
  int iterations = 0;
  bool converged = false;
  bool diverged = false;
  Distances last;  ///< of the last iteration
};

/// Kalman update, linearized again after each step, of the prior by the distances; the covariance
/// follows once at the end, in Joseph's form.
Update iterated_update(const Belief& prior, const DistancesAt& distances,
                       const UpdateConfig& config);

}  // namespace aims::lins
