// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/biped_legs.hpp"

#include <Eigen/Geometry>
#include <array>

namespace aims {
namespace {

/// Place and speed of the sole of one leg, in the trunk: `side` is 1 left, -1 right.
void walk_chain(const BipedLegs& legs, double side, const double* angles, const double* rates,
                Eigen::Vector3d& place, Eigen::Vector3d& speed) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  std::array<Eigen::Vector3d, 6> axes, origins;
  for (std::size_t i = 0; i < legs.joints.size(); ++i) {
    const ChainJoint& joint = legs.joints[i];
    T.translate(Eigen::Vector3d(joint.offset[0], side * joint.offset[1], joint.offset[2]));
    T.rotate(Eigen::AngleAxisd(joint.pitch, Eigen::Vector3d::UnitY()));
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(joint.axis);
    axes[i] = T.linear() * axis;
    origins[i] = T.translation();
    T.rotate(Eigen::AngleAxisd(angles[i], axis));
  }
  place = T * Eigen::Vector3d(0.0, 0.0, -legs.sole);
  speed.setZero();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    speed += rates[i] * axes[i].cross(place - origins[i]);
  }
}

}  // namespace

std::optional<FeetReading> biped_feet(const BipedLegs& legs, Time stamp,
                                      const std::vector<double>& angles,
                                      const std::vector<double>& rates) {
  const std::size_t each = legs.joints.size();
  if (angles.size() < 2 * each || rates.size() < 2 * each) return std::nullopt;
  FeetReading reading;
  reading.stamp = stamp;
  for (std::size_t leg = 0; leg < reading.position.size(); ++leg) {
    const std::size_t right = leg % 2;
    walk_chain(legs, right == 0 ? 1.0 : -1.0, angles.data() + right * each,
               rates.data() + right * each, reading.position[leg], reading.velocity[leg]);
  }
  return reading;
}

std::optional<FootLoads> knee_torques(const std::vector<double>& torques, const BipedLegs& legs) {
  const std::size_t each = legs.joints.size();
  if (torques.size() < 2 * each) return std::nullopt;
  FootLoads loads{};
  for (std::size_t leg = 0; leg < loads.size(); ++leg) {
    loads[leg] = torques[(leg % 2) * each + legs.knee];
  }
  return loads;
}

}  // namespace aims
