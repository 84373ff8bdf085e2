// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "estimator/filter/error_state.hpp"

namespace aims {

/// A linearized measurement of three rows: residual(x [+] d) ~ residual + jacobian d, zero at the
/// truth up to `noise`.
struct LinearMeasurement {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  Matrix3xError jacobian = Matrix3xError::Zero();
  Eigen::Matrix3d noise = Eigen::Matrix3d::Identity();  ///< covariance
};

/// Measurements of any number of rows in information form: A = H^T R^-1 H, b = H^T R^-1 r.
struct Information {
  ErrorMatrix matrix = ErrorMatrix::Zero();
  ErrorVector vector = ErrorVector::Zero();
};

/// The information of one three-row measurement.
Information information_of(const LinearMeasurement& measurement);

/// The information of rows that depend on the pose alone: 6x6 matrix and 6-vector.
Information pose_information(const Matrix6& matrix, const Vector6& vector);

/// Gaussian belief: nominal state and covariance of its error.
struct Belief {
  NominalState state;
  ErrorMatrix covariance = ErrorMatrix::Identity();
};

/// Inverse of a covariance (symmetric, positive definite).
ErrorMatrix inverse_spd(const ErrorMatrix& matrix);

/// The Kalman update in information form: the belief after fusing `measurements`, linearized at
/// `linearization`, with the prior mean `prior` and inverse prior covariance `prior_information`.
/// With linearization == prior it is the standard update, otherwise one step of the iterated
/// update. The covariance is that of the error about the returned state.
Belief kalman_update(const NominalState& prior, const ErrorMatrix& prior_information,
                     const NominalState& linearization, const Information& measurements);

/// The same with the gain K replaced by `gain_mask` K (Schmidt-Kalman update): masked directions
/// keep their value and their uncertainty. The covariance is Joseph's form for this gain.
Belief kalman_update(const NominalState& prior, const ErrorMatrix& prior_information,
                     const NominalState& linearization, const Information& measurements,
                     const ErrorMatrix& gain_mask);

/// The gain mask that corrects every state.
inline ErrorMatrix correct_all() { return ErrorMatrix::Identity(); }

/// `gain_mask` with the leg states as consider states: not corrected.
ErrorMatrix consider_legs(ErrorMatrix gain_mask);

/// `gain_mask` with the position as a consider state: not corrected.
ErrorMatrix consider_position(ErrorMatrix gain_mask);

/// `gain_mask` with the correction of position and velocity multiplied by `factor` (3x3, odometry
/// axes).
ErrorMatrix limit_motion(ErrorMatrix gain_mask, const Eigen::Matrix3d& factor);

}  // namespace aims
