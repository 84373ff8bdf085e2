// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/leg_compliance.hpp"

#include <Eigen/LU>
#include <cmath>

namespace aims {
namespace {

double inverse_or_zero(double stiffness) { return stiffness > 0.0 ? 1.0 / stiffness : 0.0; }

}  // namespace

LegCompliance::LegCompliance(const LegOdometryConfig& config, const LegGeometry& legs,
                             Duration timestep)
    : legs_(legs),
      joint_compliance_(inverse_or_zero(config.joint_stiffness)),
      foot_compliance_(inverse_or_zero(config.foot_stiffness)),
      gain_(1.0 - std::exp(-to_seconds(timestep) / config.compliance_time)),
      timestep_(to_seconds(timestep)) {}

/// Displacement of the joint angles by the force on the foot [rad].
Eigen::Vector3d LegCompliance::static_deflection(int leg, const RobotState& truth) const {
  const Eigen::Vector3d force = truth.T_world_base.rotation.conjugate() * truth.foot_force[leg];
  const Eigen::Matrix3d J = foot_jacobian(leg, joints_of(truth.q, leg), legs_);
  // The damping bounds the answer where the leg is straight and J has no inverse.
  const Eigen::Matrix3d damped = J.transpose() * J + 1e-6 * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d torque = J.transpose() * force;
  return joint_compliance_ * torque + foot_compliance_ * damped.inverse() * torque;
}

JointMotion LegCompliance::update(const RobotState& truth) {
  if (joint_compliance_ == 0.0 && foot_compliance_ == 0.0) return {truth.q, truth.qd};
  JointVector target;
  for (int leg = 0; leg < kLegCount; ++leg) {
    target.segment<3>(3 * leg) = static_deflection(leg, truth);
  }
  const JointVector change =
      started_ ? JointVector(gain_ * (target - deflection_)) : JointVector::Zero();
  deflection_ = started_ ? JointVector(deflection_ + change) : target;
  started_ = true;
  return {truth.q - deflection_, truth.qd - change / timestep_};
}

}  // namespace aims
