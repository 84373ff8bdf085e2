// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "bench/metrics/posterior_bound.hpp"
#include "core/lie.hpp"

namespace aims {

/// The linear model of IMU and legs about the true motion that both posterior bounds share.
namespace bound_model {

/// Offsets of the error state: rotation in body axes (right), position and velocity in world axes,
/// biases in body axes, the legs' scale.
enum Offset { kRotation = 0, kPosition = 3, kVelocity = 6, kGyro = 9, kForce = 12, kScale = 15 };
inline constexpr int kSize = 16;

using Matrix = Eigen::Matrix<double, kSize, kSize>;
using PoseRows = Eigen::Matrix<double, 6, kSize>;

/// Covariance of the state at the first true pose.
Matrix initial_covariance(const TrueMotion& start, const BoundParameters& parameters);

/// Jacobian of the error after the step from `a` to `b` of length `dt` [s] in the error at `a`.
Matrix transition(const TrueMotion& a, const TrueMotion& b, double dt);

/// Covariance that the IMU adds in a step of `dt` [s].
Matrix step_noise(const BoundParameters& parameters, double dt);

/// Information of the leg packets of `dt` [s]: z = (1 + scale) times the base's velocity in base
/// axes.
Matrix leg_information(const TrueMotion& at, const BoundParameters& parameters, double dt);

/// Jacobian of the body's pose as `ScanInformation` has it (rotation, then translation, both in
/// body axes) in the state.
PoseRows pose_rows(const Pose& T_world_body);

/// The bound of a state with the covariance `P` at a true motion.
PosteriorBound bound_at(const Matrix& P, const TrueMotion& at);

/// The motion at an instant between two of its samples.
TrueMotion between(const TrueMotion& a, const TrueMotion& b, Time stamp);

}  // namespace bound_model
}  // namespace aims
