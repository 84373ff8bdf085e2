// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// Mean variances per axis of a belief, of the rotation and of the velocity across the robot: along
/// it a corridor may leave the velocity free.
struct MotionVariance {
  double rotation = 0.0;  ///< [rad^2]
  double velocity = 0.0;  ///< [m^2/s^2]

  MotionVariance& operator+=(const MotionVariance& other) {
    rotation += other.rotation;
    velocity += other.velocity;
    return *this;
  }
  friend MotionVariance operator-(const MotionVariance& a, const MotionVariance& b) {
    return {a.rotation - b.rotation, a.velocity - b.velocity};
  }
};

inline MotionVariance motion_variance(const Belief& belief) {
  using E = ErrorState;
  const auto velocity = block(belief.covariance, E::kVelocity, E::kVelocity);
  const Eigen::Vector3d ahead = belief.state.rotation * Eigen::Vector3d::UnitX();
  const double along = ahead.dot(velocity * ahead);
  return {block(belief.covariance, E::kRotation, E::kRotation).trace() / 3.0,
          (velocity.trace() - along) / 2.0};
}

}  // namespace aims
