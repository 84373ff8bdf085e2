// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/leg_kilo/observations.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/leg_kinematics.hpp"

namespace aims::leg_kilo {

namespace {

/// Height of the hips over the feet of a standing robot, of thigh and calf together [-].
constexpr double kStandingHeight = 0.7;

/// A foot at `position` in base axes that moves at `velocity` there. As in the published program,
/// the IMU is taken to be at the base.
StandingFoot in_body(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity,
                     const Pose& T_body_base) {
  return {T_body_base.rotation * position, T_body_base.rotation * velocity};
}

}  // namespace

bool has_joints(const LegOdometrySample& sample, const SensorRig& rig) {
  const bool angles =
      std::ranges::any_of(sample.joint_position, [](double angle) { return angle != 0.0; });
  return angles && rig.leg_geometry.thigh > 0.0;
}

const std::array<bool, kLegCount>& ContactHysteresis::update(const LegOdometrySample& sample) {
  if (!sample.contact_force) return contact_ = sample.contact;
  for (std::size_t leg = 0; leg < contact_.size(); ++leg) {
    const double force = (*sample.contact_force)[leg];
    contact_[leg] = contact_[leg] ? !(force < end_) : force > begin_;
  }
  return contact_;
}

std::vector<StandingFoot> feet_in_contact(const LegOdometrySample& sample, const SensorRig& rig) {
  const Eigen::Map<const JointVector> angles(sample.joint_position.data());
  const Eigen::Map<const JointVector> rates(sample.joint_velocity.data());
  std::vector<StandingFoot> feet;
  for (int leg = 0; leg < kLegCount; ++leg) {
    if (!sample.contact[static_cast<std::size_t>(leg)]) continue;
    const Eigen::Vector3d q = joints_of(angles, leg);
    feet.push_back(in_body(foot_in_base(leg, q, rig.leg_geometry),
                           foot_jacobian(leg, q, rig.leg_geometry) * joints_of(rates, leg),
                           rig.T_body_base));
  }
  return feet;
}

std::vector<StandingFoot> feet_of_twist(const LegOdometrySample& sample, const SensorRig& rig) {
  const LegGeometry& geometry = rig.leg_geometry;
  std::vector<StandingFoot> feet;
  for (int leg = 0; leg < kLegCount; ++leg) {
    const Eigen::Vector3d below(0.0, side_of(leg) * geometry.abduction,
                                -kStandingHeight * (geometry.thigh + geometry.calf));
    const Eigen::Vector3d position = hip_in_base(leg, geometry) + below;
    const Eigen::Vector3d velocity =
        -sample.linear_velocity - sample.angular_velocity.cross(position);
    feet.push_back(in_body(position, velocity, rig.T_body_base));
  }
  return feet;
}

namespace {

constexpr int kInertialRows = 6;

/// The rows of one standing foot, from row `at` on.
void set_foot(const State& x, const StandingFoot& foot, double variance, Eigen::Index at,
              Observation& rows) {
  using E = Error;
  const Eigen::Matrix3d R = x.T_world_body.R();
  const Eigen::Vector3d moving = x.rate.cross(foot.position) + foot.velocity;
  rows.innovation.segment<3>(at) = -(x.velocity + R * moving);
  rows.jacobian.block<3, 3>(at, E::kRotation) = -R * hat(moving);
  rows.jacobian.block<3, 3>(at, E::kVelocity).setIdentity();
  rows.jacobian.block<3, 3>(at, E::kRate) = -R * hat(foot.position);
  rows.variance.segment<3>(at).setConstant(variance);
}

}  // namespace

Observation inertial_observation(const State& x, const Inertial& reading,
                                 std::span<const StandingFoot> feet, const ImuVariances& imu,
                                 double foot_variance) {
  using E = Error;
  Observation rows(kInertialRows + 3 * static_cast<Eigen::Index>(feet.size()));
  rows.innovation.head<3>() = reading.force - x.force - x.accelerometer_bias;
  rows.innovation.segment<3>(3) = reading.rate - x.rate - x.gyro_bias;
  rows.jacobian.block<3, 3>(0, E::kForce).setIdentity();
  rows.jacobian.block<3, 3>(0, E::kAccelerometerBias).setIdentity();
  rows.jacobian.block<3, 3>(3, E::kRate).setIdentity();
  rows.jacobian.block<3, 3>(3, E::kGyroBias).setIdentity();
  rows.variance.head<3>() << imu.force, imu.force, imu.vertical_force;
  rows.variance.segment<3>(3).setConstant(imu.rate);
  Eigen::Index at = kInertialRows;
  for (const StandingFoot& foot : feet) {
    set_foot(x, foot, foot_variance, at, rows);
    at += 3;
  }
  return rows;
}

ScanPoint scan_point(const Eigen::Vector3d& p_lidar, const Pose& T_body_lidar, const Belief& belief,
                     const PointNoise& noise) {
  const Pose& T_world_body = belief.state.T_world_body;
  const Eigen::Matrix3d R = T_world_body.R();
  ScanPoint point;
  point.in_body = T_body_lidar * p_lidar;
  point.in_world = T_world_body * point.in_body;
  const Eigen::Vector3d beam = R * (T_body_lidar.rotation * p_lidar.normalized());
  const double across = p_lidar.norm() * std::sin(noise.beam_sigma_deg * std::numbers::pi / 180.0);
  const double along = noise.range_sigma;
  point.beam_covariance = (along * along - across * across) * beam * beam.transpose();
  point.beam_covariance.diagonal().array() += across * across;
  const Eigen::Matrix3d lever = R * hat(point.in_body);
  const auto& P = belief.covariance;
  point.covariance = point.beam_covariance +
                     lever * part(P, Error::kRotation, Error::kRotation) * lever.transpose() +
                     part(P, Error::kPosition, Error::kPosition);
  return point;
}

PoseObservation point_observation(const State& x, std::span<const PointOnPlane> points,
                                  double variance_factor) {
  const auto rows = static_cast<Eigen::Index>(points.size());
  PoseObservation observation{Eigen::VectorXd(rows), {}, Eigen::VectorXd(rows)};
  observation.jacobian.resize(rows, Error::kPose);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const PointOnPlane& point = points[static_cast<std::size_t>(i)];
    const Eigen::Vector3d normal_in_body = x.T_world_body.rotation.conjugate() * point.normal;
    observation.innovation(i) = -point.distance;
    observation.jacobian.row(i) << point.in_body.cross(normal_in_body).transpose(),
        point.normal.transpose();
    observation.variance(i) = variance_factor * point.variance;
  }
  return observation;
}

}  // namespace aims::leg_kilo
