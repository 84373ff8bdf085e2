// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "recordings/inspection/clock_offset.hpp"

namespace aims {

/// The rotation of one interval as two sensors on one body see it.
struct RotationPair {
  Eigen::Vector3d imu = Eigen::Vector3d::Zero();    ///< rotation vector in the IMU frame [rad]
  Eigen::Vector3d lidar = Eigen::Vector3d::Zero();  ///< in the LiDAR frame [rad]
};

/// Rotation of an interval, or about an axis in it, that counts: a turn, not noise [rad].
inline constexpr double kLeastRotation = 0.05;

/// What rotations say of one axis of the gyro, with the given mount.
struct AxisCheck {
  int intervals = 0;         ///< in which LiDAR odometry turns about it
  double scale = 1.0;        ///< rotation of the gyro over that of LiDAR odometry, signed [-]
  double correlation = 0.0;  ///< of the two [-]
  /// Whether the body turned about it often enough.
  bool observable() const;
};

/// What rotations say of the mount of the LiDAR on the IMU and of the axes of the gyro.
struct MountCheck {
  int intervals = 0;              ///< in which the body turns
  std::array<AxisCheck, 3> axes;  ///< x, y, z of the IMU
  bool one_axis = false;          ///< all turns are about one axis: the mount about it is free
  double given_residual = 0.0;    ///< mean of squared differences over squared rotations [-]
  double best_residual = 0.0;     ///< of the hypothesis that fits best
  bool contradicts = false;       ///< another hypothesis fits clearly better
  std::string cause;              ///< "the extrinsic is inverted"; empty unless it contradicts
  bool correctable = false;       ///< the cause is a mount, not the axes of the gyro
  /// The mount that fits best; the given one where none is a rotation.
  Eigen::Quaterniond R_imu_lidar = Eigen::Quaterniond::Identity();
  /// Whether there were enough rotations to judge.
  bool checked() const;
};

/// Compares the given mount with its inverse, with IMUs turned by right angles or upside down, with
/// a mount that is off by some degrees, and with axes of the gyro of another sign or scale. Of
/// those that fit alike, the ones under which `up`, the specific force in the IMU frame while the
/// body stands upright (zero: not known), points up for the LiDAR go first. A rotation about the
/// one axis of all turns is not observable: mounts that differ by it alone fit alike, and the given
/// one stays.
MountCheck check_mount(std::span<const RotationPair> pairs, const Eigen::Quaterniond& R_imu_lidar,
                       const Eigen::Vector3d& up = Eigen::Vector3d::Zero());

/// What the turn rates of LiDAR odometry and gyro say of unit and clocks.
struct RateCheck {
  double scale = 1.0;  ///< mean rate of the gyro over that of LiDAR odometry [-]; 0: hardly turns
  std::optional<ClockOffset> clock;  ///< of the LiDAR to the IMU; nothing where it does not show
  /// Whether no noise, but a unit explains the scale.
  bool is_wrong_unit() const;
};

/// Compares rates of the norm, which no mount changes; each is in order of time.
RateCheck check_rates(const std::vector<TurnRate>& lidar, const std::vector<TurnRate>& gyro);

}  // namespace aims
