// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>

#include "core/leg_geometry.hpp"
#include "core/measurements.hpp"

namespace aims {

/// One number per joint, leg by leg: abduction, hip, knee.
using JointVector = Eigen::Matrix<double, kJointCount, 1>;

/// Contact model of a foot.
enum class FootModel {
  kPoint,    ///< the centre of the foot is static: underestimates, since a round foot rolls
  kRolling,  ///< the foot rolls on its contact point
};

/// Names of the legs in the model, in the order of all per-leg arrays.
inline constexpr std::array<std::string_view, kLegCount> kLegNames = {"FL", "FR", "RL", "RR"};

/// +1 for a leg on the left, -1 on the right.
constexpr double side_of(int leg) { return leg % 2 == 0 ? 1.0 : -1.0; }

/// Position of the hip (abduction axis) of `leg` in the base frame [m].
Eigen::Vector3d hip_in_base(int leg, const LegGeometry& geometry);

/// Angles of the joints of one leg out of all twelve [rad].
inline Eigen::Vector3d joints_of(const JointVector& q, int leg) { return q.segment<3>(3 * leg); }

/// Centre of the foot sphere in the base frame [m] at the joint angles `q` [rad].
Eigen::Vector3d foot_in_base(int leg, const Eigen::Vector3d& q,
                             const LegGeometry& geometry);

/// d foot_in_base / d q, 3x3 [m/rad].
Eigen::Matrix3d foot_jacobian(int leg, const Eigen::Vector3d& q,
                              const LegGeometry& geometry);

/// Angular velocity of the calf with respect to the base, in base axes [rad/s].
Eigen::Vector3d calf_rate_in_base(const Eigen::Vector3d& q, const Eigen::Vector3d& rate);

/// Joint angles [rad] that place the foot's centre at `foot` in the base frame [m], knee backwards.
/// For a point out of reach the leg has the nearest possible length.
Eigen::Vector3d leg_angles(int leg, const Eigen::Vector3d& foot,
                           const LegGeometry& geometry);

/// Joint motion of one leg and rotation of the base at an instant.
struct LegMotion {
  Eigen::Vector3d q;        ///< angles of the leg's joints [rad]
  Eigen::Vector3d rate;     ///< of these angles [rad/s]
  Eigen::Vector3d turning;  ///< angular velocity of the base, in base axes [rad/s]
};

/// Velocity of the base in base axes [m/s] if the centre of that leg's foot is static.
Eigen::Vector3d velocity_from_foot(int leg, const LegMotion& motion,
                                   const LegGeometry& geometry);

/// Velocity of the base in base axes [m/s] if the round foot rolls on ground with the normal `up`,
/// a unit vector in base axes.
Eigen::Vector3d velocity_from_rolling_foot(int leg, const LegMotion& motion,
                                           const Eigen::Vector3d& up,
                                           const LegGeometry& geometry);

}  // namespace aims
