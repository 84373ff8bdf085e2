// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/config.hpp"
#include "core/measurements.hpp"
#include "estimator/filter/imu_propagation.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// Random walks of the mount [rad/sqrt(s)] and the delay [s/sqrt(s)].
inline constexpr double kMountWalk = 1e-5;
inline constexpr double kDelayWalk = 5e-5;

/// Rotation of the LiDAR's mount and delay of the IMU's stamps as filter states.
struct CalibrationConfig {
  bool enabled = true;        ///< false: both are known exactly
  double mount_sigma = 5e-3;  ///< initial, per axis [rad]
  double delay_sigma = 2e-3;  ///< initial, beyond how the IMU averages [s]
};

void describe(Fields& fields, CalibrationConfig& config);

/// The belief with the first mount and delay; a mount with a deviation of zero is known. A sample
/// of an IMU with `imu_rate_hz` [Hz] may be the value at its stamp or the mean over the interval
/// before it, so its delay is between 0 and half that interval.
Belief open_calibration(Belief belief, const CalibrationConfig& config, double imu_rate_hz);

/// Adds the random walk of mount and delay over `dt` [s].
void walk_calibration(Belief& belief, const CalibrationConfig& config, double dt);

/// The LiDAR frame in the body frame with the estimated mount; `nominal` is that of the rig.
Pose corrected_mount(const NominalState& state, const Pose& nominal);

/// Deviation of the LiDAR's position in the rig, per axis [m]: a CAD model or a tape measure.
inline constexpr double kLeverSigma = 5e-3;

/// Covariance of the position at `now` [m^2] by two errors of the rig that no state holds; odometry
/// axes, about the position at `first`, the first pose. Scans determine the LiDAR's path in the
/// axes of the gyro. An error e of its position moves the body by (R_first - R) e. An angle a
/// between the gyro's axes and the body's, known no better than the mount, turns the path about
/// the vertical z: by z^T (R_first a) z x (p - p_first).
Eigen::Matrix3d rig_covariance(const Pose& first, const Pose& now, const CalibrationConfig& config);

/// Mean motion of the body during a scan.
struct MeanTwist {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< odometry axes [m/s]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< body axes [rad/s]
};

/// The twist over `segments`, which end at `end_state`.
MeanTwist mean_twist(const NominalState& end_state, std::span<const InertialSegment> segments,
                     double gravity);

/// How a scan depends on mount and delay: its rows are a point-to-plane row j of the pose with
/// j_mount = j_rotation - hat(t) R^T j_position, t of the mount, and
/// j_delay = w . j_rotation + v . j_position, so that information about the pose gives all.
struct CalibrationModel {
  Eigen::Vector3d lever = Eigen::Vector3d::Zero();  ///< t, position of the LiDAR, body axes [m]
  MeanTwist twist;
  /// NominalState::mount and delay that its points in body axes were computed with.
  Eigen::Quaterniond mount = Eigen::Quaterniond::Identity();
  double delay = 0.0;  ///< [s]
};

/// The body pose at which the points of a scan lie where `state` says: its own, turned and moved by
/// what its mount and delay differ from those that the points have.
Pose scan_pose(const NominalState& state, const CalibrationModel& model);

/// `state` with the body pose for which scan_pose() is `pose`.
NominalState at_scan_pose(NominalState state, const Pose& pose, const CalibrationModel& model);

/// A scan as a measurement of pose, mount and delay, from its information about the pose (matrix
/// h^T R^-1 h and vector h^T R^-1 r) at the attitude `R`.
PoseMeasurement scan_measurement(const Matrix6& matrix, const Vector6& vector,
                                 const CalibrationModel& model, const Eigen::Matrix3d& R);

/// The belief after its delay has changed by `change` [s]: the same motion, which is now at another
/// time of the LiDAR's clock, moved on to the time of the belief.
Belief after_delay_change(Belief belief, double change, const MeanTwist& twist);

}  // namespace aims
