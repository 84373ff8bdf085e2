// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "core/measurements.hpp"
#include "recordings/reading_notes.hpp"

namespace aims {

/// What a sample of the IMU did to the half seconds over which velocities are compared.
enum class ForceStep { kRefused, kBeganAnew, kAdded, kClosedWindow };

/// Velocities by the IMU and by the legs over half seconds, with given signs of the specific force.
class SignedForce {
 public:
  /// Of the IMU [m/s].
  struct Velocities {
    Eigen::Vector3d by_force, by_legs;
  };

  explicit SignedForce(const Eigen::Vector3d& signs) : signs_(signs) {}

  /// In base axes; `place` is that of the IMU in the base.
  ForceStep add_imu(const ImuSample& sample, const Eigen::Vector3d& place);
  /// The velocity of the base by the legs, in base axes [m/s].
  void add_legs(const Eigen::Vector3d& velocity);

  bool has_begun() const { return last_.has_value(); }
  const Eigen::Quaterniond& R_world_base() const { return R_world_base_; }
  /// The last angular velocity [rad/s].
  const Eigen::Vector3d& turning() const { return turning_; }
  /// Samples of the IMU in a second, apart from gaps.
  double imu_rate() const { return steps_ > 0 ? steps_ / time_ : 0.0; }

  /// Means over the window that closed last, in axes of the world; nothing of few samples.
  const std::optional<Velocities>& window() const { return window_; }
  /// Its difference from the window before, in axes of the base without its tilt.
  const std::optional<Velocities>& change() const { return change_; }

  /// Changes of the velocity that were compared.
  int count() const { return count_; }
  /// Root mean square of the differences between the changes along x and y of the base [m/s].
  Eigen::Array2d residual() const;

 private:
  void close();

  Eigen::Vector3d signs_;
  std::optional<Time> last_;  ///< stamp of the IMU
  Time begin_ = 0;            ///< of the window
  Eigen::Quaterniond R_world_base_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  ///< integrated, of the IMU [m/s]
  Eigen::Vector3d turning_ = Eigen::Vector3d::Zero();   ///< the last angular velocity [rad/s]
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();     ///< of the IMU in the base [m]
  int imu_ = 0, legs_ = 0;                              ///< samples of the window
  Velocities sum_ = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  std::optional<Velocities> window_, change_;
  double time_ = 0.0;  ///< between samples of the IMU, in all [s]
  int steps_ = 0;      ///< how many
  int count_ = 0;
  Eigen::Array2d squared_ = Eigen::Array2d::Zero();
};

/// Finds an axis of the accelerometer that has the wrong sign: with the other one, the velocity
/// changes as the legs say. A tilt that the gyro sees and the accelerometer mirrors shows it also
/// where the robot walks straight ahead.
class AxisSigns {
 public:
  ForceStep add_imu(const ImuSample& sample, const Eigen::Vector3d& place);
  void add_legs(const Eigen::Vector3d& velocity);
  const SignedForce& measured() const { return measured_; }
  std::optional<ReadingWarning> warning() const;
  /// Whether the velocity along x changes more as the legs say with the other sign.
  bool mirrored_x_fits() const;

 private:
  SignedForce measured_{{1.0, 1.0, 1.0}};
  std::array<SignedForce, 2> mirrored_ = {SignedForce({-1.0, 1.0, 1.0}),
                                          SignedForce({1.0, -1.0, 1.0})};  ///< along x, y
};

}  // namespace aims
