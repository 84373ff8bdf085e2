// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace aims::lio_sam {

/// Angles of R = R_z(yaw) R_y(pitch) R_x(roll) [rad].
struct RollPitchYaw {
  double roll = 0.0;
  double pitch = 0.0;
  double yaw = 0.0;
};

RollPitchYaw angles_of(const Eigen::Quaterniond& rotation);

Eigen::Quaterniond rotation_of(const RollPitchYaw& angles);

/// The rotation with roll and pitch moved towards those of an attitude by `weight`, each on its
/// own; unchanged when the attitude points steeply up or down.
Eigen::Quaterniond levelled(const Eigen::Quaterniond& rotation, const RollPitchYaw& attitude,
                            double weight);

}  // namespace aims::lio_sam
