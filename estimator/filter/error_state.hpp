// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/lie.hpp"

namespace aims {

/// Layout of the 25-D error state, defined here alone: the 15-D of the paper's eq. (1), scale and
/// bias of the leg odometry, and mount and delay of the sensors; states that a variant does not
/// estimate stay at their first value. Right perturbation: R = R_hat Exp(d_rotation); the mount is
/// R_body_lidar = Exp(d_mount) R_hat; every other block adds. Position and velocity errors are in
/// odometry axes, errors of biases and mount in body axes, leg errors in base axes.
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
  static constexpr Block kLegScale{15};           ///< [-]
  static constexpr Block kLegBias{18};            ///< [m/s]
  static constexpr Block kMount{21};              ///< rotation of the LiDAR's mount [rad]
  static constexpr int kDelay = 24;               ///< of the IMU's stamps [s], one entry
  static constexpr int kPoseSize = 6;             ///< rotation and position come first
  static constexpr int kMotionSize = 15;          ///< without legs and calibration
  static constexpr int kLegSize = 6;              ///< scale and bias of the legs
  static constexpr int kSize = 25;
};

using Vector6 = Eigen::Matrix<double, ErrorState::kPoseSize, 1>;
using Matrix6 = Eigen::Matrix<double, ErrorState::kPoseSize, ErrorState::kPoseSize>;
using ErrorVector = Eigen::Matrix<double, ErrorState::kSize, 1>;
using ErrorMatrix = Eigen::Matrix<double, ErrorState::kSize, ErrorState::kSize>;

using Matrix3xError = Eigen::Matrix<double, 3, ErrorState::kSize>;
using Matrix6xError = Eigen::Matrix<double, ErrorState::kPoseSize, ErrorState::kSize>;

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

/// The 6x6 rotation-and-position part of a matrix over the error state.
template <class Matrix>
auto pose_block(Matrix& matrix) {
  return matrix.template topLeftCorner<ErrorState::kPoseSize, ErrorState::kPoseSize>();
}

/// The rotation-and-position entries of an error vector.
template <class Vector>
auto pose_segment(Vector& vector) {
  return vector.template head<ErrorState::kPoseSize>();
}

/// State of the filter, eq. (1): x = [R, p, v, b_g, b_a], scale and bias of the legs, mount and
/// delay.
struct NominalState {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< R_odom_body
  Eigen::Vector3d position = Eigen::Vector3d::Zero();            ///< p_odom_body [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();            ///< in odometry axes [m/s]
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();           ///< [rad/s]
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();  ///< [m/s^2]
  /// Leg odometry reports (1 + scale) v + bias for the base velocity v, per axis.
  Eigen::Vector3d leg_scale = Eigen::Vector3d::Zero();  ///< [-]
  Eigen::Vector3d leg_bias = Eigen::Vector3d::Zero();   ///< [m/s]
  /// Correction of the mount: R_body_lidar = mount * R_body_lidar of the rig.
  Eigen::Quaterniond mount = Eigen::Quaterniond::Identity();
  double delay = 0.0;  ///< the IMU's stamps are late by this on the LiDAR's clock [s]

  Pose T_odom_body() const { return {rotation, position}; }
};

/// state [+] delta.
NominalState boxplus(const NominalState& state, const ErrorVector& delta);

/// state [-] origin: the error delta with origin [+] delta = state.
ErrorVector boxminus(const NominalState& state, const NominalState& origin);

/// The covariance of the error about state [+] delta, from that of the error about `state`
/// (symmetric): the reset of the perturbations of the rotations; all other blocks add.
ErrorMatrix reset_covariance(ErrorMatrix covariance, const ErrorVector& delta);

/// True when every entry of the state is a finite number.
bool is_finite(const NominalState& state);

}  // namespace aims
