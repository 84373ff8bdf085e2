// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "core/measurements.hpp"

namespace aims {

/// The orientation that an IMU reports beside its samples: gyro integrated, roll and pitch drawn to
/// the felt gravity, heading free to drift from zero. Made of the samples alone, never of truth.
class AttitudeFilter {
 public:
  /// Takes the next sample; yields the body's orientation in a level frame at its stamp.
  Eigen::Quaterniond update(const ImuSample& sample);

 private:
  std::optional<Time> last_;
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
};

}  // namespace aims
