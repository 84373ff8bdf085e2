// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/config.hpp"

namespace aims {

/// How a swinging foot moves over the ground.
enum class SwingShape {
  kMinimumJerk,  ///< smooth: at rest over the ground at lift-off and at touchdown
  kRamped,       ///< gains and loses its speed quickly and lands in motion
};

/// Path of a foot between lift-off and touchdown. All but the shape is of the ramped path alone.
struct SwingPathConfig {
  SwingShape shape = SwingShape::kMinimumJerk;
  double speed_up = 0.25;   ///< part of the swing in which the foot gains its speed [-]
  double slow_down = 0.25;  ///< part in which it loses it before touchdown [-]
  double retraction = 0.2;  ///< backward speed at touchdown over the largest forward speed [-]
  double lift = 0.0;        ///< part of the swing in which the foot moves before it rises [-]
  double descent = 0.7;     ///< downward speed at touchdown [m/s]
};
void describe(Fields& f, SwingPathConfig& c);

/// From where to where a foot swings, in the world.
struct Swing {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d to = Eigen::Vector3d::Zero();    ///< [m]
  double apex = 0.0;                               ///< height in mid-swing [m]
  double time = 0.0;                               ///< of the whole swing [s]
};

/// A place on the path and the velocity there.
struct SwingPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]
};

/// Where the foot is to be after the part `s` of its swing, in [0, 1].
SwingPoint swing_point(const SwingPathConfig& config, const Swing& swing, double s);

}  // namespace aims
