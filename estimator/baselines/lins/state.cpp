// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lins/state.hpp"

#include <algorithm>
#include <cmath>

namespace aims::lins {

State plus(const State& x, const ErrorVector& error) {
  State moved = x;
  moved.motion.translation += part(error, Error::kPosition);
  moved.motion.rotation = (x.motion.rotation * so3_exp(part(error, Error::kRotation))).normalized();
  moved.velocity += part(error, Error::kVelocity);
  moved.accelerometer_bias += part(error, Error::kAccelerometerBias);
  moved.gyro_bias += part(error, Error::kGyroBias);
  moved.gravity += part(error, Error::kGravity);
  return moved;
}

ErrorVector minus(const State& to, const State& from) {
  ErrorVector error;
  part(error, Error::kPosition) = to.motion.translation - from.motion.translation;
  part(error, Error::kRotation) = so3_log(from.motion.rotation.conjugate() * to.motion.rotation);
  part(error, Error::kVelocity) = to.velocity - from.velocity;
  part(error, Error::kAccelerometerBias) = to.accelerometer_bias - from.accelerometer_bias;
  part(error, Error::kGyroBias) = to.gyro_bias - from.gyro_bias;
  part(error, Error::kGravity) = to.gravity - from.gravity;
  return error;
}

bool is_finite(const Belief& belief) {
  const State& x = belief.state;
  return x.motion.rotation.coeffs().allFinite() && x.motion.translation.allFinite() &&
         x.velocity.allFinite() && x.accelerometer_bias.allFinite() && x.gyro_bias.allFinite() &&
         x.gravity.allFinite() && belief.covariance.allFinite();
}

Eigen::Quaterniond levelled(const Eigen::Quaterniond& R_world_lidar,
                            const Eigen::Vector3d& gravity) {
  const double sign = gravity.z() >= 0.0 ? 1.0 : -1.0;
  const auto angle = [](double component) {
    return std::asin(std::clamp(component / kGravity, -1.0, 1.0));
  };
  const double pitch = -sign * angle(gravity.x());
  const double roll = sign * angle(gravity.y());
  return yaw_rotation(yaw_of(R_world_lidar)) *
         Eigen::Quaterniond(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                            Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()));
}

Belief rebased(const Belief& belief, bool turn_gravity) {
  const Eigen::Matrix3d R_present_last = belief.state.motion.R().transpose();
  Belief next;
  next.state = belief.state;
  next.state.motion = Pose();
  next.state.velocity = R_present_last * belief.state.velocity;
  if (turn_gravity) next.state.gravity = R_present_last * belief.state.gravity;
  next.state.gravity *= kGravity / next.state.gravity.norm();
  const auto keep = [&](int block, const Eigen::Matrix3d& turn) {
    part(next.covariance, block, block) =
        turn * part(belief.covariance, block, block) * turn.transpose();
  };
  keep(Error::kVelocity, R_present_last);
  keep(Error::kAccelerometerBias, Eigen::Matrix3d::Identity());
  keep(Error::kGyroBias, Eigen::Matrix3d::Identity());
  keep(Error::kGravity, R_present_last);
  return next;
}

}  // namespace aims::lins
