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

ErrorMatrix boxminus_jacobian(const NominalState& /*origin*/, const ErrorVector& delta) {
  ErrorMatrix jacobian = ErrorMatrix::Identity();
  block(jacobian, ErrorState::kRotation, ErrorState::kRotation) =
      so3_right_jacobian_inverse(segment(delta, ErrorState::kRotation));
  block(jacobian, ErrorState::kMount, ErrorState::kMount) =
      so3_right_jacobian_inverse(-segment(delta, ErrorState::kMount));
  return jacobian;
}

ErrorMatrix reset_jacobian(const NominalState& /*state*/, const ErrorVector& delta) {
  ErrorMatrix jacobian = ErrorMatrix::Identity();
  block(jacobian, ErrorState::kRotation, ErrorState::kRotation) =
      so3_right_jacobian(segment(delta, ErrorState::kRotation));
  block(jacobian, ErrorState::kMount, ErrorState::kMount) =
      so3_right_jacobian(-segment(delta, ErrorState::kMount));
  return jacobian;
}

bool is_finite(const NominalState& state) {
  return state.rotation.coeffs().allFinite() && state.position.allFinite() &&
         state.velocity.allFinite() && state.gyro_bias.allFinite() &&
         state.accelerometer_bias.allFinite() && state.leg_scale.allFinite() &&
         state.leg_bias.allFinite() && state.mount.coeffs().allFinite() &&
         std::isfinite(state.delay);
}

}  // namespace aims
