// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/lie.hpp"

namespace aims {

/// Layout of the 15-D error state, the only place that knows it. Right perturbation:
/// R = R_hat Exp(d_rotation); every other block adds. Position and velocity errors are in odometry
/// axes, bias errors in body axes.
struct ErrorState {
  /// Three consecutive entries of the error state.
  struct Block {
    int offset;
  };
  static constexpr Block kRotation{0};            ///< [rad]
  static constexpr Block kPosition{3};            ///< [m]
  static constexpr Block kVelocity{6};            ///< [m/s]
  static constexpr Block kGyroBias{9};            ///< [rad/s]
  static constexpr Block kAccelerometerBias{12};  ///< [m/s^2]
  static constexpr int kPoseSize = 6;             ///< rotation and position come first
  static constexpr int kSize = 15;
};

using Vector6 = Eigen::Matrix<double, ErrorState::kPoseSize, 1>;
using Matrix6 = Eigen::Matrix<double, ErrorState::kPoseSize, ErrorState::kPoseSize>;
using Vector15 = Eigen::Matrix<double, ErrorState::kSize, 1>;
using Matrix15 = Eigen::Matrix<double, ErrorState::kSize, ErrorState::kSize>;

using Matrix3x6 = Eigen::Matrix<double, 3, ErrorState::kPoseSize>;
using Matrix3x15 = Eigen::Matrix<double, 3, ErrorState::kSize>;
using Matrix6x15 = Eigen::Matrix<double, ErrorState::kPoseSize, ErrorState::kSize>;

/// The three columns of `matrix` that belong to `block`.
template <class Matrix>
auto columns(Matrix& matrix, ErrorState::Block block) {
  return matrix.template middleCols<3>(block.offset);
}

/// The 3x3 part of `matrix` in the rows of `row` and the columns of `column`.
template <class Matrix>
auto block(Matrix& matrix, ErrorState::Block row, ErrorState::Block column) {
  return matrix.template block<3, 3>(row.offset, column.offset);
}

/// The three entries of `vector` that belong to `block`.
template <class Vector>
auto segment(Vector& vector, ErrorState::Block block) {
  return vector.template segment<3>(block.offset);
}

/// The 6x6 rotation-and-position part of a 15x15 matrix.
template <class Matrix>
auto pose_block(Matrix& matrix) {
  return matrix.template topLeftCorner<ErrorState::kPoseSize, ErrorState::kPoseSize>();
}

/// The 6x15 rotation-and-position rows of a 15x15 matrix.
template <class Matrix>
auto pose_rows(Matrix& matrix) {
  return matrix.template topRows<ErrorState::kPoseSize>();
}

/// The rotation-and-position entries of a 15-vector.
template <class Vector>
auto pose_segment(Vector& vector) {
  return vector.template head<ErrorState::kPoseSize>();
}

/// State of the filter, eq. (1): x = [R, p, v, b_g, b_a].
struct NominalState {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< R_odom_body
  Eigen::Vector3d position = Eigen::Vector3d::Zero();            ///< p_odom_body [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();            ///< in odometry axes [m/s]
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();           ///< [rad/s]
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();  ///< [m/s^2]

  Pose T_odom_body() const { return {rotation, position}; }
};

/// The state moved by the error `delta`: state [+] delta.
NominalState boxplus(const NominalState& state, const Vector15& delta);

/// The error that moves `origin` to `state`: state [-] origin.
Vector15 boxminus(const NominalState& state, const NominalState& origin);

/// Jacobian of ((state [+] d) [-] origin) in d at d = 0, where delta = state [-] origin.
Matrix15 boxminus_jacobian(const Vector15& delta);

/// Jacobian that carries the error about a state to the error about state [+] delta:
/// the covariance reset of the right perturbation.
Matrix15 reset_jacobian(const Vector15& delta);

/// True when every entry of the state is a finite number.
bool is_finite(const NominalState& state);

}  // namespace aims
