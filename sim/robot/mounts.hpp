// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "core/config.hpp"
#include "core/lie.hpp"

namespace aims {

/// How far the true mounts lie from those that the estimators are told, drawn per run.
struct CalibrationErrorConfig {
  double rotation_sigma_deg = 0.0;  ///< of a mount, per axis [deg]
  double translation_sigma = 0.0;   ///< of a mount, per axis [m]
};
void describe(Fields& f, CalibrationErrorConfig& c);

/// Where the IMU and the LiDAR really are.
struct Mounts {
  Pose T_base_body;   ///< IMU frame, which is the body frame, in the trunk's
  Pose T_body_lidar;  ///< LiDAR frame in the body's
};

/// The true mounts of a run: the nominal ones, each turned and shifted by its draw. Streams:
/// "calibration.imu", "calibration.lidar".
Mounts true_mounts(const Mounts& nominal, const CalibrationErrorConfig& config,
                   std::uint64_t run_seed);

}  // namespace aims
