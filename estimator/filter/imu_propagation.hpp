// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/time.hpp"
#include "estimator/aims/config.hpp"
#include "estimator/filter/error_state.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// A span of time over which angular rate and specific force (body axes, bias included) are
/// constant.
struct InertialSegment {
  Time begin = 0;
  Time end = 0;
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();    ///< [m/s^2]
  bool measured = true;  ///< false: bridges missing samples, with the noise of a guess
};

/// The nominal state `dt` [s] later (earlier when negative): exact for constant rate and force.
NominalState propagate_state(const NominalState& state, const InertialSegment& segment, double dt,
                             double gravity);

/// Jacobian F of the error after `dt` in the error before it.
ErrorMatrix propagation_jacobian(const NominalState& state, const InertialSegment& segment,
                                 double dt);

/// Covariance that `dt` [s] of inertial noise and bias walk add; isotropic, so that it
/// is the same in body and odometry axes.
ErrorMatrix propagation_noise(const ImuPropagationConfig& config, bool measured, double dt);

/// The belief `dt` [s] later.
Belief propagate(const Belief& belief, const InertialSegment& segment, double dt,
                 const ImuPropagationConfig& config);

}  // namespace aims
