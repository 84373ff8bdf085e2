// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/config.hpp"

namespace aims {

/// Periodic motion of the trunk within a stride, as a trotting robot's: it sinks in mid-stance, or
/// vaults over its standing legs, rolls once and pitches twice per stride. While the robot stands
/// there is none.
struct TrunkMotionConfig {
  double bounce = 0.0015;  ///< amplitude of the height [m]
  double vault = 0.0;      ///< amplitude of the height, highest in mid-stance [m]
  double roll = 0.04;      ///< amplitude [rad]
  double pitch = 0.028;    ///< amplitude [rad]
};
void describe(Fields& f, TrunkMotionConfig& c);

/// What the trunk is to do beyond keeping its height and staying level, in its heading frame.
struct TrunkReference {
  double height = 0.0;                                             ///< [m]
  double velocity = 0.0;                                           ///< vertical [m/s]
  double acceleration = 0.0;                                       ///< vertical [m/s^2]
  Eigen::Vector3d tilt = Eigen::Vector3d::Zero();                  ///< roll, pitch, 0 [rad]
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();                  ///< of the tilt [rad/s]
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();  ///< of the tilt [rad/s^2]
};

/// The reference at `phase` of a stride [0, 1), whose mid-stances are at half of `duty_factor` and
/// half a stride later. The trunk is lowest, and the force on the feet largest, in mid-stance,
/// where the roll passes zero; the pitch leads mid-stance. A vault larger than the bounce turns the
/// first two around.
TrunkReference trunk_reference(const TrunkMotionConfig& config, double phase, double duty_factor,
                               double period);

/// The reference at a fraction of its amplitude.
TrunkReference operator*(double fraction, const TrunkReference& reference);

}  // namespace aims
