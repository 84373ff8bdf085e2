// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "estimator/filter/error_state.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// A copy of the pose at an earlier instant and what its error shares with the error of the present
/// state (stochastic cloning). Rows and columns of the clone are the pose blocks of ErrorState.
struct PoseClone {
  Pose T_odom_body;
  Matrix6 covariance = Matrix6::Zero();
  Matrix6xError cross_covariance = Matrix6xError::Zero();  ///< clone by present state
};

/// The clone at its birth: the belief's pose, with an error that is the pose's own.
PoseClone clone_pose(const Belief& belief);

/// The clone after the present error went through the propagation `F`: the clone stands still, so
/// that process noise is new to it.
PoseClone propagate_clone(const PoseClone& clone, const ErrorMatrix& F);

/// A linearised measurement of three rows that sees a clone and the present state: its residual is
/// ~ residual + clone_jacobian c + jacobian d for the errors c of the clone and d of the state.
struct RelativeMeasurement {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  Matrix3x6 clone_jacobian = Matrix3x6::Zero();
  Matrix3xError jacobian = Matrix3xError::Zero();
  Eigen::Matrix3d noise = Eigen::Matrix3d::Identity();  ///< covariance
};

/// `measurement` with the clone marginalised. The clone's error is split into its regression on the
/// present error, c = K d + e with K = P_cd P_dd^-1, and a remainder e that is independent of d and
/// joins the noise. kalman_update() of the result gives state and covariance of the joint update of
/// both (21-D), exact for the linearised measurement; the clone's own posterior is not formed.
/// `state_information` is P_dd^-1.
LinearMeasurement marginalise_clone(const RelativeMeasurement& measurement, const PoseClone& clone,
                                    const ErrorMatrix& state_information);

}  // namespace aims
