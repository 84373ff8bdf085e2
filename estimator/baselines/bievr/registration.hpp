// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "core/lie.hpp"
#include "estimator/baselines/bievr/bump_map.hpp"

namespace aims::bievr {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Rotation first, then position, both by right steps T (Exp(rotation), position) in body axes.
struct LinearCost {
  double cost = 0.0;                   ///< Huber's, of residuals [m^2]
  double absolute = 0.0;               ///< sum of the absolute residuals [m]
  int used = 0;                        ///< points with a surface
  Matrix6 hessian = Matrix6::Zero();   ///< J^T W J
  Vector6 gradient = Vector6::Zero();  ///< J^T W r
};

/// A point's height over the surface of its voxel and its derivative in a step of the pose.
struct Residual {
  double value = 0.0;  ///< [m]
  Vector6 jacobian = Vector6::Zero();
};

/// Of `p_body` [m] at the pose, with R of it: r = z - I(x, y) in the image of the nearest voxel;
/// none without one.
std::optional<Residual> residual(const BumpMap& map, const Pose& T_world_body,
                                 const Eigen::Matrix3d& R, const Eigen::Vector3d& p_body,
                                 bool relief);

LinearCost linearize(const BumpMap& map, const Pose& T_world_body,
                     std::span<const Eigen::Vector3d> points, const RegistrationConfig& config);

/// The pose that fits the points to the map, and the cost where it was linearized last.
struct Registered {
  Pose T_world_body;
  LinearCost last;
  int iterations = 0;
  bool converged = false;
};

/// Levenberg-Marquardt from `start`. The prediction is where it begins and nothing else: along a
/// direction without information the pose keeps what it predicted.
Registered registered(const BumpMap& map, const Pose& start,
                      std::span<const Eigen::Vector3d> points, const RegistrationConfig& config);

}  // namespace aims::bievr
