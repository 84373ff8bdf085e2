// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/measurements.hpp"
#include "estimator/aims/config.hpp"
#include "estimator/filter/pose_clone.hpp"
#include "estimator/legs/leg_displacement.hpp"

namespace aims {

/// Leg odometry as relative motion between two scan ends: how far the leg odometry's base moved
/// since the clone, in the base axes of the clone,
/// R_body_base^T (R_c^T (p + R l - p_c) - l) with l = p_body_base.
/// `measured` is that displacement [m].
RelativeMeasurement leg_displacement_model(const Pose& T_odom_clone, const NominalState& state,
                                           const Pose& T_body_base, const Eigen::Vector3d& measured,
                                           const Eigen::Matrix3d& noise);

/// Covariance of a displacement [m^2], base axes: that of the mean of its packets' velocities, of
/// which each has R_leg = leg_velocity_noise() at the mean velocity, times the duration squared.
/// With no packet lost it carries the information that the same packets carry as velocities; each
/// lost packet takes its share away.
Eigen::Matrix3d leg_displacement_noise(const LegConfig& config, const LegDisplacement& measured);

}  // namespace aims
