// SPDX-License-Identifier: BSD-3-Clause
#include "sim/leg_kinematics.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace aims {
namespace {

constexpr LegGeometry g = kLegGeometry;

Eigen::Matrix3d abduction_rotation(double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()).toRotationMatrix();
}

/// A rod of that length hanging down, turned about the y axis.
Eigen::Vector3d rod(double length, double angle) {
  return {-length * std::sin(angle), 0.0, -length * std::cos(angle)};
}

}  // namespace

Eigen::Vector3d hip_in_base(int leg) {
  return {leg < 2 ? g.hip_x : -g.hip_x, side_of(leg) * g.hip_y, 0.0};
}

Eigen::Vector3d foot_in_base(int leg, const Eigen::Vector3d& q) {
  const Eigen::Vector3d in_leg = Eigen::Vector3d(0.0, side_of(leg) * g.abduction, 0.0) +
                                 rod(g.thigh, q[1]) + rod(g.calf, q[1] + q[2]);
  return hip_in_base(leg) + abduction_rotation(q[0]) * in_leg;
}

Eigen::Matrix3d foot_jacobian(int leg, const Eigen::Vector3d& q) {
  const Eigen::Matrix3d R = abduction_rotation(q[0]);
  const Eigen::Vector3d pitch_axis = R.col(1);
  const Eigen::Vector3d calf = R * rod(g.calf, q[1] + q[2]);
  const Eigen::Vector3d leg_rods = R * rod(g.thigh, q[1]) + calf;
  Eigen::Matrix3d J;
  J.col(0) = Eigen::Vector3d::UnitX().cross(foot_in_base(leg, q) - hip_in_base(leg));
  J.col(1) = pitch_axis.cross(leg_rods);
  J.col(2) = pitch_axis.cross(calf);
  return J;
}

Eigen::Vector3d calf_rate_in_base(int, const Eigen::Vector3d& q, const Eigen::Vector3d& rate) {
  const Eigen::Vector3d pitch_axis = abduction_rotation(q[0]).col(1);
  return rate[0] * Eigen::Vector3d::UnitX() + (rate[1] + rate[2]) * pitch_axis;
}

Eigen::Vector3d leg_angles(int leg, const Eigen::Vector3d& foot) {
  const Eigen::Vector3d p = foot - hip_in_base(leg);
  const double offset = side_of(leg) * g.abduction;
  const double across = std::max(std::hypot(p.y(), p.z()), std::abs(offset) + 1e-6);
  const double down = std::sqrt(across * across - offset * offset);
  const double q0 = std::atan2(p.y(), -p.z()) - std::atan2(offset, down);

  const double shortest = std::abs(g.thigh - g.calf) + 0.05;
  const double longest = g.thigh + g.calf - 1e-3;
  const double length = std::clamp(std::hypot(p.x(), down), shortest, longest);
  const double cos_knee =
      (length * length - g.thigh * g.thigh - g.calf * g.calf) / (2.0 * g.thigh * g.calf);
  const double q2 = -std::acos(std::clamp(cos_knee, -1.0, 1.0));
  const double direction = std::atan2(-p.x(), down);
  const double q1 = direction - std::atan2(g.calf * std::sin(q2), g.thigh + g.calf * std::cos(q2));
  return {q0, q1, q2};
}

}  // namespace aims
