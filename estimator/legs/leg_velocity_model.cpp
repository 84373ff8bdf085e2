// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/leg_velocity_model.hpp"

#include <algorithm>

namespace aims {

void describe(Fields& f, LegConfig& c) {
  f.flag("enabled", c.enabled, {"", any(), "fuse leg odometry"});
  f.flag("repeat_lost", c.repeat_lost,
         {"", any(), "repeat the last packet while packets are lost (zero-order hold)"});
  f.vector("velocity_sigma", c.velocity_sigma,
           {"m/s", positive_up_to(1e3),
            "error of one sample along the base axes, R_leg; with cross_validation 0.1 until the "
            "leg scale is known; no effect where feet serve, which need no reported velocity",
            "docs/decisions.md#leg-noise-of-003-ms-per-sample"});
  f.number(
      "scale_sigma", c.scale_sigma,
      {"-", up_to(1e6),
       "error proportional to the speed, R_leg; with cross_validation 0.05 until the leg scale "
       "is known; no effect where feet serve, as velocity_sigma",
       "docs/decisions.md#leg-noise-of-003-ms-per-sample"});
}

LinearMeasurement leg_velocity_model(const NominalState& state, const Pose& T_body_base,
                                     const Eigen::Vector3d& angular_velocity,
                                     const LegVelocity& legs, const Eigen::Matrix3d& noise) {
  using E = ErrorState;
  const Eigen::Matrix3d R_base_body = T_body_base.R().transpose();
  const Eigen::Matrix3d R_body_odom = state.rotation.conjugate().toRotationMatrix();
  const Eigen::Vector3d& lever = T_body_base.translation;
  const Eigen::Vector3d velocity_in_body = R_body_odom * state.velocity;
  const Eigen::Vector3d rate = angular_velocity - state.gyro_bias;
  LinearMeasurement m;
  m.residual = R_base_body * (velocity_in_body + rate.cross(lever)) +
               state.leg_scale.cwiseProduct(legs.stride_mean) + state.leg_bias - legs.measured;
  columns(m.jacobian, E::kRotation) = R_base_body * hat(velocity_in_body);
  columns(m.jacobian, E::kVelocity) = R_base_body * R_body_odom;
  columns(m.jacobian, E::kGyroBias) = R_base_body * hat(lever);
  columns(m.jacobian, E::kLegScale) = legs.past_mean.asDiagonal();
  columns(m.jacobian, E::kLegBias).setIdentity();
  m.noise = noise;
  return m;
}

Eigen::Vector3d uncorrected_residual(const LinearMeasurement& measurement,
                                     const NominalState& state, const LegVelocity& legs) {
  return measurement.residual - state.leg_scale.cwiseProduct(legs.stride_mean) - state.leg_bias;
}

Eigen::Matrix3d leg_velocity_noise(const LegConfig& config, double rate_hz, double speed) {
  const double scale_error = config.scale_sigma * speed;
  const Eigen::Vector3d variance =
      config.velocity_sigma.cwiseAbs2() + Eigen::Vector3d::Constant(scale_error * scale_error);
  const double correlated_samples = std::max(1.0, 2.0 * kLegCorrelationTime * rate_hz);
  return (correlated_samples * variance).asDiagonal();
}

}  // namespace aims
