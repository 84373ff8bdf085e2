// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/leg_kinematics.hpp"
#include "sim/robot/world.hpp"
#include "sim/sensors/joint_encoders.hpp"

namespace aims {

/// Deflection of the legs under load. The encoders sit before the compliant part: they read what
/// the joints would be if the foot, at its true place in the base frame, were at the end of a rigid
/// leg that has not yet yielded by J^-1 C f + K^-1 J^T f. Here f is the force on the foot, C = 1/k
/// of the rubber foot, K the stiffness of the joints, and the deflection follows with a time
/// constant (rubber damps).
class LegCompliance {
 public:
  /// `legs` as drawn.
  LegCompliance(const LegOdometryConfig& config, const LegGeometry& legs, Duration timestep);

  /// Joint motion at the encoders after a physics step; call once per step.
  JointMotion update(const RobotState& truth);

 private:
  Eigen::Vector3d static_deflection(int leg, const RobotState& truth) const;

  LegGeometry legs_;
  double joint_compliance_;  ///< [rad/(N m)]
  double foot_compliance_;   ///< [m/N]
  double gain_;              ///< of the low-pass, per physics step
  double timestep_;          ///< [s]
  bool started_ = false;
  JointVector deflection_ = JointVector::Zero();  ///< true less measured angles [rad]
};

}  // namespace aims
