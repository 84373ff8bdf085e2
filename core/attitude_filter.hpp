// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "core/measurements.hpp"

namespace aims {

/// The orientation that an IMU reports with its samples: integrated gyro, roll and pitch corrected
/// by the measured gravity, heading with drift from zero. It uses the samples alone, no truth.
class AttitudeFilter {
 public:
  /// Processes the next sample; returns the body's orientation in a level frame at its stamp.
  Eigen::Quaterniond update(const ImuSample& sample);

 private:
  std::optional<Time> last_;
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
};

}  // namespace aims
