// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/error_state.hpp"

#include <cmath>

namespace aims {

NominalState boxplus(const NominalState& state, const ErrorVector& delta) {
  NominalState moved;
  moved.rotation = (state.rotation * so3_exp(segment(delta, ErrorState::kRotation))).normalized();
  moved.position = state.position + segment(delta, ErrorState::kPosition);
  moved.velocity = state.velocity + segment(delta, ErrorState::kVelocity);
  moved.gyro_bias = state.gyro_bias + segment(delta, ErrorState::kGyroBias);
  moved.accelerometer_bias =
      state.accelerometer_bias + segment(delta, ErrorState::kAccelerometerBias);
  moved.leg_scale = state.leg_scale + segment(delta, ErrorState::kLegScale);
  moved.leg_bias = state.leg_bias + segment(delta, ErrorState::kLegBias);
  moved.mount = (so3_exp(segment(delta, ErrorState::kMount)) * state.mount).normalized();
  moved.delay = state.delay + delta(ErrorState::kDelay);
  return moved;
}

ErrorVector boxminus(const NominalState& state, const NominalState& origin) {
  ErrorVector delta;
  segment(delta, ErrorState::kRotation) = so3_log(origin.rotation.conjugate() * state.rotation);
  segment(delta, ErrorState::kPosition) = state.position - origin.position;
  segment(delta, ErrorState::kVelocity) = state.velocity - origin.velocity;
  segment(delta, ErrorState::kGyroBias) = state.gyro_bias - origin.gyro_bias;
  segment(delta, ErrorState::kAccelerometerBias) =
      state.accelerometer_bias - origin.accelerometer_bias;
  segment(delta, ErrorState::kLegScale) = state.leg_scale - origin.leg_scale;
  segment(delta, ErrorState::kLegBias) = state.leg_bias - origin.leg_bias;
  segment(delta, ErrorState::kMount) = so3_log(state.mount * origin.mount.conjugate());
  delta(ErrorState::kDelay) = state.delay - origin.delay;
  return delta;
}

ErrorMatrix reset_covariance(ErrorMatrix covariance, const ErrorVector& delta) {
  const auto change = [&covariance](ErrorState::Block block, const Eigen::Matrix3d& jacobian) {
    auto rows = covariance.middleRows<3>(block.offset);
    rows = jacobian.lazyProduct(rows).eval();
    auto columns = covariance.middleCols<3>(block.offset);
    columns = columns.lazyProduct(jacobian.transpose()).eval();
  };
  change(ErrorState::kRotation, so3_right_jacobian(segment(delta, ErrorState::kRotation)));
  change(ErrorState::kMount, so3_right_jacobian(-segment(delta, ErrorState::kMount)));
  return 0.5 * (covariance + covariance.transpose());
}

bool is_finite(const NominalState& state) {
  return state.rotation.coeffs().allFinite() && state.position.allFinite() &&
         state.velocity.allFinite() && state.gyro_bias.allFinite() &&
         state.accelerometer_bias.allFinite() && state.leg_scale.allFinite() &&
         state.leg_bias.allFinite() && state.mount.coeffs().allFinite() &&
         std::isfinite(state.delay);
}

}  // namespace aims
