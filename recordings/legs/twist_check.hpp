// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/measurements.hpp"

namespace aims {

/// Compares an odometry's twist with its pose. By ROS's convention the twist is in base axes, but
/// some drivers use the axes of the odometry frame.
class TwistCheck {
 public:
  /// True at the end of a second of motion that only a twist in odometry axes explains.
  bool add(const LegOdometrySample& sample);

 private:
  std::optional<LegOdometrySample> start_, last_;
  Eigen::Vector3d by_base_axes_ = Eigen::Vector3d::Zero();  ///< displacement since the start [m]
  Eigen::Vector3d by_odometry_axes_ =
      Eigen::Vector3d::Zero();  ///< displacement since the start [m]
};

}  // namespace aims
