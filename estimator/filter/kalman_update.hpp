// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "estimator/filter/error_state.hpp"

namespace aims {

/// A linearised measurement of three rows: residual(x [+] d) ~ residual + jacobian d, which is zero
/// up to `noise` at the truth.
struct LinearMeasurement {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  Matrix3xError jacobian = Matrix3xError::Zero();
  Eigen::Matrix3d noise = Eigen::Matrix3d::Identity();  ///< covariance
};

/// What measurements of any number of rows say about the error state: A = H^T R^-1 H, b = H^T R^-1
/// r.
struct Information {
  ErrorMatrix matrix = ErrorMatrix::Zero();
  ErrorVector vector = ErrorVector::Zero();
};

/// The information in one three-row measurement.
Information information_of(const LinearMeasurement& measurement);

/// The information of rows that see the pose alone: 6x6 matrix and 6-vector.
Information pose_information(const Matrix6& matrix, const Vector6& vector);

/// Gaussian belief: nominal state and covariance of its error.
struct Belief {
  NominalState state;
  ErrorMatrix covariance = ErrorMatrix::Identity();
};

/// Inverse of a covariance (symmetric, positive definite).
ErrorMatrix inverse_spd(const ErrorMatrix& matrix);

/// The one Kalman update, in information form: the belief after fusing `measurements`, linearised
/// at `linearization`, with the prior whose state is `prior` and inverse covariance
/// `prior_information`. With linearization == prior it is the plain update; elsewhere it is one
/// step of the iterated update. The covariance belongs to the error about the returned state.
Belief kalman_update(const NominalState& prior, const ErrorMatrix& prior_information,
                     const NominalState& linearization, const Information& measurements);

/// The same with the gain K replaced by `mask` K: what the mask takes away is considered as
/// uncertain, but not corrected (Schmidt-Kalman update). The covariance is that of this gain.
Belief kalman_update(const NominalState& prior, const ErrorMatrix& prior_information,
                     const NominalState& linearization, const Information& measurements,
                     const ErrorMatrix& mask);

/// The mask that corrects everything.
inline ErrorMatrix correct_all() { return ErrorMatrix::Identity(); }

/// `mask` without the states of the legs.
ErrorMatrix hold_legs(ErrorMatrix mask);

/// `mask` without the position.
ErrorMatrix hold_position(ErrorMatrix mask);

/// `mask` with correction of position and velocity only as `kept` (3x3, odometry axes) allows.
ErrorMatrix hold_motion(ErrorMatrix mask, const Eigen::Matrix3d& kept);

}  // namespace aims
