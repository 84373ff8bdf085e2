// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/sensor_calibration.hpp"

#include <cmath>

namespace aims {
namespace {

void add_variance(ErrorMatrix& covariance, double mount, double delay) {
  block(covariance, ErrorState::kMount, ErrorState::kMount).diagonal().array() += mount * mount;
  covariance(ErrorState::kDelay, ErrorState::kDelay) += delay * delay;
}

}  // namespace

void describe(Fields& f, CalibrationConfig& c) {
  f.flag("enabled", c.enabled,
         {"", any(), "estimate the rotation of the LiDAR's mount and the delay of the IMU"});
  f.number("mount_sigma", c.mount_sigma,
           {"rad", positive_up_to(1.0), "initial error of the mount's rotation, per axis",
            "target-free calibration: 0.1 to 0.5 deg"});
  f.number("delay_sigma", c.delay_sigma,
           {"s", positive_up_to(0.1), "initial error of the clocks",
            "clocks set over a network: 1 to 5 ms"});
  f.idle_if(!c.enabled, "enabled is false", {"mount_sigma", "delay_sigma"});
}

Belief open_calibration(Belief belief, const CalibrationConfig& config, double imu_rate_hz) {
  const double quarter = 0.25 / imu_rate_hz;  // between a sample at an instant and a mean
  belief.state.delay = quarter;
  if (config.enabled) {
    add_variance(belief.covariance, config.mount_sigma, std::hypot(config.delay_sigma, quarter));
  }
  return belief;
}

void walk_calibration(Belief& belief, const CalibrationConfig& config, double dt) {
  if (!config.enabled) return;
  const double mount_walk = config.mount_sigma > 0.0 ? kMountWalk : 0.0;
  add_variance(belief.covariance, mount_walk * std::sqrt(dt), kDelayWalk * std::sqrt(dt));
}

Pose corrected_mount(const NominalState& state, const Pose& nominal) {
  return {state.mount * nominal.rotation, nominal.translation};
}

Eigen::Matrix3d rig_covariance(const Pose& first, const Pose& now,
                               const CalibrationConfig& config) {
  if (!config.enabled) return Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d lever = kLeverSigma * (first.R() - now.R());
  const Eigen::Vector3d turned =
      config.mount_sigma * Eigen::Vector3d::UnitZ().cross(now.translation - first.translation);
  return lever * lever.transpose() + turned * turned.transpose();
}

MeanTwist mean_twist(const NominalState& end_state, std::span<const InertialSegment> segments,
                     double gravity) {
  NominalState begin = end_state;
  double duration = 0.0;
  for (std::size_t i = segments.size(); i-- > 0;) {
    const double dt = to_seconds(segments[i].end - segments[i].begin);
    begin = propagate_state(begin, segments[i], -dt, gravity);
    duration += dt;
  }
  if (!(duration > 0.0)) return {end_state.velocity, Eigen::Vector3d::Zero()};
  return {(end_state.position - begin.position) / duration,
          so3_log(begin.rotation.conjugate() * end_state.rotation) / duration};
}

Pose scan_pose(const NominalState& state, const CalibrationModel& model) {
  const Eigen::Quaterniond& R = state.rotation;
  const Eigen::Vector3d turned = so3_log(state.mount * model.mount.conjugate());
  const double late = state.delay - model.delay;
  return {(R * so3_exp(turned + late * model.twist.angular_velocity)).normalized(),
          state.position + R * model.lever.cross(turned) + late * model.twist.velocity};
}

NominalState at_scan_pose(NominalState state, const Pose& pose, const CalibrationModel& model) {
  state.rotation.setIdentity();
  state.position.setZero();
  state.rotation = (pose.rotation * scan_pose(state, model).rotation.conjugate()).normalized();
  state.position = pose.translation - scan_pose(state, model).translation;
  return state;
}

PoseMeasurement scan_measurement(const Matrix6& matrix, const Vector6& vector,
                                 const CalibrationModel& model, const Eigen::Matrix3d& R) {
  using E = ErrorState;
  PoseMeasurement measurement{matrix, vector};
  Matrix6xError& J = measurement.jacobian;
  J.block<3, 3>(E::kRotation.offset, E::kMount.offset).setIdentity();
  J.block<3, 3>(E::kPosition.offset, E::kMount.offset) = R * hat(model.lever);
  J.block<3, 1>(E::kRotation.offset, E::kDelay) = model.twist.angular_velocity;
  J.block<3, 1>(E::kPosition.offset, E::kDelay) = model.twist.velocity;
  return measurement;
}

Belief after_delay_change(Belief belief, double change, const MeanTwist& twist) {
  belief.state.rotation =
      (belief.state.rotation * so3_exp(change * twist.angular_velocity)).normalized();
  belief.state.position += change * twist.velocity;
  return belief;
}

}  // namespace aims
