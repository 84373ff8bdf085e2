// SPDX-License-Identifier: BSD-3-Clause
#include "core/leg_kinematics.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/config.hpp"

namespace aims {
namespace {

Eigen::Matrix3d abduction_rotation(double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()).toRotationMatrix();
}

/// End of a rod that hangs down, rotated about the y axis.
Eigen::Vector3d rod(double length, double angle) {
  return {-length * std::sin(angle), 0.0, -length * std::cos(angle)};
}

}  // namespace

Eigen::Vector3d hip_in_base(int leg, const LegGeometry& g) {
  return {leg < 2 ? g.hip_x : -g.hip_x, side_of(leg) * g.hip_y, 0.0};
}

Eigen::Vector3d foot_in_base(int leg, const Eigen::Vector3d& q, const LegGeometry& g) {
  const Eigen::Vector3d in_leg = Eigen::Vector3d(0.0, side_of(leg) * g.abduction, 0.0) +
                                 rod(g.thigh, q[1]) + rod(g.calf, q[1] + q[2]);
  return hip_in_base(leg, g) + abduction_rotation(q[0]) * in_leg;
}

Eigen::Matrix3d foot_jacobian(int leg, const Eigen::Vector3d& q, const LegGeometry& g) {
  const Eigen::Matrix3d R = abduction_rotation(q[0]);
  const Eigen::Vector3d pitch_axis = R.col(1);
  const Eigen::Vector3d calf = R * rod(g.calf, q[1] + q[2]);
  const Eigen::Vector3d leg_rods = R * rod(g.thigh, q[1]) + calf;
  Eigen::Matrix3d J;
  J.col(0) = Eigen::Vector3d::UnitX().cross(foot_in_base(leg, q, g) - hip_in_base(leg, g));
  J.col(1) = pitch_axis.cross(leg_rods);
  J.col(2) = pitch_axis.cross(calf);
  return J;
}

Eigen::Vector3d calf_rate_in_base(const Eigen::Vector3d& q, const Eigen::Vector3d& rate) {
  const Eigen::Vector3d pitch_axis = abduction_rotation(q[0]).col(1);
  return rate[0] * Eigen::Vector3d::UnitX() + (rate[1] + rate[2]) * pitch_axis;
}

Eigen::Vector3d leg_angles(int leg, const Eigen::Vector3d& foot, const LegGeometry& g) {
  const Eigen::Vector3d p = foot - hip_in_base(leg, g);
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

Eigen::Vector3d velocity_from_foot(int leg, const LegMotion& motion, const LegGeometry& g) {
  const auto& [q, rate, turning] = motion;
  return -(foot_jacobian(leg, q, g) * rate + turning.cross(foot_in_base(leg, q, g)));
}

Eigen::Vector3d velocity_from_rolling_foot(int leg, const LegMotion& motion,
                                           const Eigen::Vector3d& up, const LegGeometry& g) {
  const Eigen::Vector3d foot_turning = motion.turning + calf_rate_in_base(motion.q, motion.rate);
  return velocity_from_foot(leg, motion, g) + foot_turning.cross(g.foot_radius * up);
}

void describe(Fields& f, LegGeometry& g) {
  const auto length = [](std::string meaning, double most = 2.0) {
    return Spec{.unit = "m", .range = up_to(most), .meaning = std::move(meaning)};
  };
  f.number("hip_x", g.hip_x, length("hip from the trunk's centre, forward or back"));
  f.number("hip_y", g.hip_y, length("hip from the trunk's centre, to either side"));
  f.number("abduction", g.abduction, length("from the abduction axis to the plane of the leg"));
  f.number("thigh", g.thigh, length("of the thigh, hip to knee"));
  f.number("calf", g.calf, length("of the calf, knee to the foot's centre"));
  f.number("foot_radius", g.foot_radius, length("of the round foot", 0.3));
}

}  // namespace aims
