// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/measurements.hpp"

namespace aims {

/// Holds the twist of an odometry against its own pose: by ROS's convention it is in the axes of
/// the base, yet some drivers give it in those of the odometry frame.
class TwistCheck {
 public:
  /// True at the end of a second in which only a twist in odometry axes explains the motion.
  bool add(const LegOdometrySample& sample);

 private:
  std::optional<LegOdometrySample> start_, last_;
  Eigen::Vector3d by_base_axes_ = Eigen::Vector3d::Zero();      ///< way since the start [m]
  Eigen::Vector3d by_odometry_axes_ = Eigen::Vector3d::Zero();  ///< way since the start [m]
};

}  // namespace aims
