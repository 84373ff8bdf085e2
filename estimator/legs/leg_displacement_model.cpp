// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/leg_displacement_model.hpp"

#include "estimator/legs/leg_velocity_model.hpp"

namespace aims {

RelativeMeasurement leg_displacement_model(const Pose& T_odom_clone, const NominalState& state,
                                           const Pose& T_body_base, const Eigen::Vector3d& measured,
                                           const Eigen::Matrix3d& noise) {
  using E = ErrorState;
  const Eigen::Matrix3d R_base_body = T_body_base.R().transpose();
  const Eigen::Matrix3d R_clone_odom = T_odom_clone.R().transpose();
  const Eigen::Matrix3d R_odom_body = state.rotation.toRotationMatrix();
  const Eigen::Vector3d& lever = T_body_base.translation;
  const Eigen::Vector3d p_clone_base =
      R_clone_odom * (state.position + R_odom_body * lever - T_odom_clone.translation);
  RelativeMeasurement m;
  m.residual = R_base_body * (p_clone_base - lever) - measured;
  columns(m.clone_jacobian, E::kRotation) = R_base_body * hat(p_clone_base);
  columns(m.clone_jacobian, E::kPosition) = -R_base_body * R_clone_odom;
  columns(m.jacobian, E::kRotation) = -R_base_body * R_clone_odom * R_odom_body * hat(lever);
  columns(m.jacobian, E::kPosition) = R_base_body * R_clone_odom;
  m.noise = noise;
  return m;
}

Eigen::Matrix3d leg_displacement_noise(const LegConfig& config, const LegDisplacement& measured) {
  const double duration = to_seconds(measured.duration);
  const Eigen::Vector3d mean_velocity = measured.translation / duration;
  return leg_velocity_noise(config, mean_velocity) * (duration * duration / measured.packets);
}

}  // namespace aims
