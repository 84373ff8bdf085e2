// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/estimate/estimate.hpp"
#include "bench/estimate/rotation_evidence.hpp"
#include "core/error.hpp"

namespace aims {

/// The check of mount, gyro and clocks for the first three minutes of a recording, in words, with
/// what each axis showed and the line that corrects mount or clock. Errors as of `estimate`.
Result<std::vector<std::string>> mount_report(const EstimateConfig& config,
                                              const EstimateOptions& options);

/// A warning where rotations of LiDAR odometry contradict the gyro or the mount.
std::optional<ReadingWarning> warning_of(const RotationEvidence& evidence, const Pose& T_imu_lidar);

}  // namespace aims
