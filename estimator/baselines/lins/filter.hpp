// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "core/config.hpp"
#include "core/lie.hpp"
#include "estimator/baselines/features/feature_matches.hpp"
#include "estimator/baselines/points/error_blocks.hpp"

namespace aims::lins {

/// Length of gravity [m/s^2].
inline constexpr double kGravity = 9.81;

/// State relative to the LiDAR at the last scan (Qin et al., LINS, ICRA 2020, section III).
struct State {
  Pose motion;                                                   ///< T_last_present
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();            ///< axes of the last scan [m/s]
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();           ///< [rad/s]
  /// In axes of the last scan [m/s^2].
  Eigen::Vector3d gravity = -kGravity * Eigen::Vector3d::UnitZ();
};

/// Blocks of the error state; the rotation is disturbed on the right.
struct Error {
  static constexpr int kPosition = 0;
  static constexpr int kVelocity = 3;
  static constexpr int kRotation = 6;
  static constexpr int kAccelerometerBias = 9;
  static constexpr int kGyroBias = 12;
  static constexpr int kGravity = 15;
  static constexpr int kSize = 18;
};

using ErrorVector = Eigen::Matrix<double, Error::kSize, 1>;
using ErrorMatrix = Eigen::Matrix<double, Error::kSize, Error::kSize>;

using points::part;

/// x [+] error.
State plus(const State& x, const ErrorVector& error);

/// The error with plus(from, error) = to.
ErrorVector minus(const State& to, const State& from);

/// State and covariance.
struct Belief {
  State state;
  ErrorMatrix covariance = ErrorMatrix::Zero();
};

bool is_finite(const Belief& belief);

/// Orientation of the LiDAR in a level frame with the heading of `R_world_lidar` and the direction
/// of gravity `gravity` in LiDAR axes.
Eigen::Quaterniond levelled(const Eigen::Quaterniond& R_world_lidar,
                            const Eigen::Vector3d& gravity);

/// The belief relative to the present LiDAR: no motion, without uncertainty; velocity in its axes.
/// Gravity follows likewise with `turn_gravity`; else only its covariance does, as in the published
/// program, which turns gravity by the motion that it has just cleared.
Belief rebased(const Belief& belief, bool turn_gravity);

/// Standard deviations of the process noise, per axis. As in the published program a step of dt
/// adds the variance (s dt)^2.
struct ProcessNoise {
  double accelerometer = 0.6867;         ///< 70000 ug [m/s^2]
  double gyro = 4.848e-7;                ///< 0.1 deg/h [rad/s]
  double accelerometer_bias = 4.905e-3;  ///< 500 ug in a second [m/s^3]
  double gyro_bias = 1.4544e-5;          ///< 0.05 deg/h^0.5 [rad/s^2]
};

void describe(Fields& fields, ProcessNoise& config);

/// What the IMU measures at an instant, LiDAR axes.
struct Inertial {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();   ///< [rad/s]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< specific force [m/s^2]
};

/// The state `dt` [s] later, with the mean rate of both ends and the mean acceleration of both,
/// each at its own attitude.
State predicted(const State& x, const Inertial& begin, const Inertial& end, double dt);

/// Derivative of the error after a step in the error before it, F = I + A dt + A^2 dt^2 / 2 with A
/// at the state after the step.
ErrorMatrix prediction_jacobian(const State& after, const Inertial& end, double dt);

/// Covariance that the noise adds in a step of `dt` [s].
ErrorMatrix prediction_noise(double dt, const ProcessNoise& noise);

/// The belief `dt` [s] later: P <- F P F^T + Q.
Belief predicted(const Belief& belief, const Inertial& begin, const Inertial& end, double dt,
                 const ProcessNoise& noise);

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
