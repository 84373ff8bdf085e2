// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/config.hpp"
#include "core/lie.hpp"
#include "estimator/baselines/pose_graph/factor_graph.hpp"

namespace aims::lio_sam {

using pose_graph::ImuBias;

using Matrix9 = Eigen::Matrix<double, 9, 9>;

/// Pose and velocity of the IMU in the map.
struct NavState {
  Pose T_map_imu;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< map axes [m/s]
};

/// Noise of the IMU, as densities; defaults of the published program.
struct ImuNoiseConfig {
  double accelerometer = 3.9939570888238808e-03;       ///< [m/s^2/sqrt(Hz)]
  double gyro = 1.5636343949698187e-03;                ///< [rad/s/sqrt(Hz)]
  double accelerometer_bias = 6.4356659353532566e-05;  ///< its random walk [m/s^2/sqrt(s)]
  double gyro_bias = 3.5640318696367613e-05;           ///< its random walk [rad/s/sqrt(s)]
  double integration = 1e-4;                           ///< of the position [m/sqrt(s)]
};

void describe(Fields& fields, ImuNoiseConfig& config);

/// Rows and columns of the 9-vector (rotation, velocity, position).
inline constexpr int kRotation = 0;
inline constexpr int kVelocity = 3;
inline constexpr int kPosition = 6;

/// Relative motion between two instants.
struct MotionDelta {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
};

/// IMU samples between two instants as one relative motion in the axes of the first, without
/// gravity and initial velocity (Forster, Carlone, Dellaert and Scaramuzza, T-RO 2017, sec. VI).
struct Preintegration {
  ImuBias bias;           ///< at which the samples were integrated
  double duration = 0.0;  ///< [s]
  MotionDelta delta;
  Matrix9 covariance = Matrix9::Zero();
  Eigen::Matrix3d rotation_by_gyro = Eigen::Matrix3d::Zero();  ///< d rotation / d bias
  Eigen::Matrix3d velocity_by_gyro = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d velocity_by_accelerometer = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d position_by_gyro = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d position_by_accelerometer = Eigen::Matrix3d::Zero();
};

/// Adds a sample that holds for `step` [s]: angular velocity [rad/s] and specific force [m/s^2].
void integrate(Preintegration& motion, const Eigen::Vector3d& rate, const Eigen::Vector3d& force,
               double step, const ImuNoiseConfig& noise);

/// The motion at another bias, to first order.
MotionDelta corrected(const Preintegration& motion, const ImuBias& bias);

/// The state after the motion, with gravity [m/s^2] along -z.
NavState predicted(const NavState& state, const Preintegration& motion, const ImuBias& bias,
                   double gravity);

// W of the biases: accelerometer before gyro.

using pose_graph::Factor;
using pose_graph::FactorGraph;
using pose_graph::Value;

/// The velocity is `mean` [m/s].
Factor velocity_prior(int velocity, const Eigen::Vector3d& mean,
                      const Eigen::MatrixXd& sqrt_information);

/// The biases are `mean`.
Factor bias_prior(int bias, const ImuBias& mean, const Eigen::MatrixXd& sqrt_information);

/// The biases stay.
Factor bias_walk(int from, int to, const Eigen::MatrixXd& sqrt_information);

/// Variables of an instant.
struct Key {
  int pose = 0;
  int velocity = 0;
  int bias = 0;
};

/// The motion from one instant to the next is that of the IMU, with the bias of the first:
///     r = (Log(D_R^T R_i^T R_j), R_i^T (v_j - v_i - g t) - D_v,
///          R_i^T (p_j - p_i - v_i t - g t^2 / 2) - D_p)
/// Empty when the motion has no samples.
std::optional<Factor> imu_factor(const Key& from, const Key& to, const Preintegration& motion,
                                 double gravity);

}  // namespace aims::lio_sam
