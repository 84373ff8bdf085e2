// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/leg_kilo/standing_feet.hpp"

#include <algorithm>

#include "core/leg_kinematics.hpp"

namespace aims::leg_kilo {
namespace {

/// Height of the hips over the feet of a standing robot, of thigh and calf together [-].
constexpr double kStandingHeight = 0.7;

/// A foot at `position` in base axes that moves at `velocity` there. As in the published program,
/// the IMU is taken to be at the base.
StandingFoot in_body(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity,
                     const Pose& T_body_base) {
  return {T_body_base.rotation * position, T_body_base.rotation * velocity};
}

}  // namespace

bool has_joints(const LegOdometrySample& sample, const SensorRig& rig) {
  const bool angles =
      std::ranges::any_of(sample.joint_position, [](double angle) { return angle != 0.0; });
  return angles && rig.leg_geometry.thigh > 0.0;
}

const std::array<bool, kLegCount>& ContactHysteresis::update(const LegOdometrySample& sample) {
  if (!sample.contact_force) return contact_ = sample.contact;
  for (std::size_t leg = 0; leg < contact_.size(); ++leg) {
    const double force = (*sample.contact_force)[leg];
    contact_[leg] = contact_[leg] ? !(force < end_) : force > begin_;
  }
  return contact_;
}

std::vector<StandingFoot> feet_in_contact(const LegOdometrySample& sample, const SensorRig& rig) {
  const Eigen::Map<const JointVector> angles(sample.joint_position.data());
  const Eigen::Map<const JointVector> rates(sample.joint_velocity.data());
  std::vector<StandingFoot> feet;
  for (int leg = 0; leg < kLegCount; ++leg) {
    if (!sample.contact[static_cast<std::size_t>(leg)]) continue;
    const Eigen::Vector3d q = joints_of(angles, leg);
    feet.push_back(in_body(foot_in_base(leg, q, rig.leg_geometry),
                           foot_jacobian(leg, q, rig.leg_geometry) * joints_of(rates, leg),
                           rig.T_body_base));
  }
  return feet;
}

std::vector<StandingFoot> feet_of_twist(const LegOdometrySample& sample, const SensorRig& rig) {
  const LegGeometry& geometry = rig.leg_geometry;
  std::vector<StandingFoot> feet;
  for (int leg = 0; leg < kLegCount; ++leg) {
    const Eigen::Vector3d below(0.0, side_of(leg) * geometry.abduction,
                                -kStandingHeight * (geometry.thigh + geometry.calf));
    const Eigen::Vector3d position = hip_in_base(leg, geometry) + below;
    const Eigen::Vector3d velocity =
        -sample.linear_velocity - sample.angular_velocity.cross(position);
    feet.push_back(in_body(position, velocity, rig.T_body_base));
  }
  return feet;
}

}  // namespace aims::leg_kilo
