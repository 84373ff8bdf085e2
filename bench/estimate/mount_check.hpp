// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/estimate/estimate.hpp"
#include "core/error.hpp"
#include "recordings/inspection/clock_offset.hpp"

namespace aims {

/// The rotation of one interval as two sensors on one body see it.
struct RotationPair {
  Eigen::Vector3d imu = Eigen::Vector3d::Zero();    ///< rotation vector in the IMU frame [rad]
  Eigen::Vector3d lidar = Eigen::Vector3d::Zero();  ///< in the LiDAR frame [rad]
};

/// What rotations say of the mount of the LiDAR on the IMU.
struct MountCheck {
  int intervals = 0;            ///< in which the body turns
  double given_residual = 0.0;  ///< mean of squared differences over squared rotations, 0 to 2 [-]
  double best_residual = 0.0;   ///< of the mount that fits best
  bool contradicts = false;     ///< another mount of right angles fits clearly better
  std::string cause;            ///< e.g. "the extrinsic is inverted"; empty unless it contradicts
  bool correctable = false;     ///< the cause is a mount, not the axes of the gyro
  /// The mount that fits best; the given one where none is a rotation.
  Eigen::Quaterniond R_imu_lidar = Eigen::Quaterniond::Identity();
};

/// Compares the given mount with its inverse and with IMUs turned by right angles, upside down, or
/// with an axis mirrored. A rotation about the one axis of all turns is not observable: mounts that
/// differ by it alone fit alike, and the given one stays.
MountCheck check_mount(std::span<const RotationPair> pairs, const Eigen::Quaterniond& R_imu_lidar);

/// What the turn rates of LiDAR odometry and gyro say of unit and clocks.
struct RateCheck {
  double scale = 1.0;  ///< mean rate of the gyro over that of LiDAR odometry [-]; 0: hardly turns
  std::optional<ClockOffset> clock;  ///< of the LiDAR to the IMU; nothing where it does not show
};

/// Compares rates of the norm, which no mount changes; each is in order of time.
RateCheck check_rates(const std::vector<TurnRate>& lidar, const std::vector<TurnRate>& gyro);

/// The check for the first three minutes of a recording, with the rotation of LiDAR odometry
/// (A-LOAM, which uses no IMU), in words, with the line that corrects mount or clock. Errors as of
/// `estimate`.
Result<std::vector<std::string>> mount_report(const EstimateConfig& config,
                                              const EstimateOptions& options);

}  // namespace aims
