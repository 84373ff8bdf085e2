// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/measurements.hpp"

namespace aims::lio_sam {

/// How far beyond a scan its samples reach, on both sides.
inline constexpr Duration kSampleMargin = 10 * kMillisecond;

/// Rotation during a scan from the gyro alone. Rates are summed up axis by axis and taken as roll,
/// pitch and yaw, as in the published program: exact only for small rotations.
class GyroRotation {
 public:
  /// Samples up to `end` in order of stamp; the first one is where the angles are zero.
  GyroRotation(const std::vector<ImuSample>& samples, Time end);

  /// Whether there are two samples, so that anything is known.
  bool available() const { return stamps_.size() > 1; }

  /// Angles about x, y and z at a time, linear between samples, constant outside [rad].
  Eigen::Vector3d angles_at(Time stamp) const;

  /// R_first_time with these angles.
  Eigen::Matrix3f rotation_at(Time stamp) const;

 private:
  std::vector<Time> stamps_;
  std::vector<Eigen::Vector3d> angles_;
};

}  // namespace aims::lio_sam
