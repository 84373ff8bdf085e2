// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/feet_odometry.hpp"

#include <algorithm>
#include <utility>

#include "estimator/filter/imu_propagation.hpp"

namespace aims {
namespace {

/// Between packets that lie further apart the height says nothing of the feet.
constexpr Duration kLongestPause = kSecond / 10;

Eigen::Vector3d up_in_base(const NominalState& state, const Pose& T_body_base) {
  return T_body_base.rotation.conjugate() * (state.rotation.conjugate() * Eigen::Vector3d::UnitZ());
}

}  // namespace

bool FeetOdometry::applies(const LegOdometrySample& sample) const {
  const Eigen::Map<const JointVector> angle(sample.joint_position.data());
  return config_.enabled && !angle.isZero(0.0) && angle.allFinite();
}

/// The state `age` [s] before `stamp`, the time of `state`, and the motion there.
FeetOdometry::Instant FeetOdometry::instant_before(Time stamp, double age,
                                                   const NominalState& state,
                                                   const ImuHistory& imu) {
  imu.segments(stamp - std::max<Duration>(from_seconds(age), 1), stamp, segments_);
  Instant instant{state, segments_.front()};
  for (auto each = segments_.rbegin(); each != segments_.rend(); ++each) {
    const double back = -to_seconds(each->end - each->begin);
    instant.state = propagate_state(instant.state, *each, back, gravity_);
  }
  return instant;
}

std::optional<JointState> FeetOdometry::joints_of_packet(const LegOdometrySample& sample,
                                                         const NominalState& state) {
  const Eigen::Map<const JointVector> angle(sample.joint_position.data());
  const Eigen::Vector3d up = up_in_base(state, rig_.T_body_base);
  const LoadShares shares = compliance_.shares(sample, rig_.leg_rate_hz);
  return difference_.update(
      {sample.stamp, angle, yield_of_joints(angle, shares, up, rig_.leg_geometry), shares});
}

/// Of new readings [Hz].
double FeetOdometry::rate_of(const JointState& joints) const {
  return rig_.leg_rate_hz / (1 + joints.repeats);
}

/// The detected contacts; all feet where no packet has reported any.
std::array<bool, kLegCount> FeetOdometry::contacts_of(const LegOdometrySample& sample) {
  contacts_reported_ = contacts_reported_ || std::ranges::count(sample.contact, true) > 0;
  std::array<bool, kLegCount> all{};
  all.fill(true);
  return contacts_reported_ ? sample.contact : all;
}

/// The true vertical velocity since the last packet with new angles [m/s]. Not that of the belief:
/// feet pull it all the time, and a scan that corrects it says so in the height.
double FeetOdometry::climb_since_last(Time stamp, double height) {
  const double since = to_seconds(stamp - std::exchange(last_stamp_, stamp));
  const double climbed = height - std::exchange(last_height_, height);
  const bool measured =
      vertical_ == VerticalReference::kHeight && since < to_seconds(kLongestPause);
  return measured ? climbed / since : 0.0;
}

/// Feet are weighted as rigid legs have them: with the present compliance the vertical drift would
/// depend on itself, and the estimate would run away.
void FeetOdometry::learn_compliance(const JointState& joints, const Eigen::Vector3d& turning,
                                    const Eigen::Vector3d& up, const FootSelection& select,
                                    double climb) {
  const FootVelocities rigid = velocities_from_feet(joints, 0.0, turning, up, rig_.leg_geometry);
  const FootWeights weights = select.weights(rigid);
  if (total_weight(weights) == 0.0) return;
  JointState yielding;
  yielding.angle = joints.angle;
  yielding.rate = joints.yield_rate;
  const FootVelocities change =
      velocities_from_feet(yielding, 0.0, Eigen::Vector3d::Zero(), up, rig_.leg_geometry);
  const Eigen::Map<const LoadShares> weight(weights.data());
  const Eigen::Vector3d yielding_more = mean_of_feet(change, weights);
  const Eigen::Vector3d level = select.predicted - up.dot(select.predicted) * up;
  compliance_.update({.climb = up.dot(mean_of_feet(rigid, weights)) - climb,
                      .joints = up.dot(yielding_more),
                      .rubber = -weight.dot(joints.load_rate) / weight.sum(),
                      .along = level.stableNormalized().dot(yielding_more),
                      .speed = level.norm()},
                     rate_of(joints));
}

std::optional<LinearMeasurement> FeetOdometry::measure(const LegOdometrySample& sample,
                                                       const Belief& belief,
                                                       const ImuHistory& imu) {
  const std::optional<JointState> joints = joints_of_packet(sample, belief.state);
  if (!joints) return std::nullopt;
  const double climb = climb_since_last(sample.stamp, belief.state.position.z());
  const auto [state, motion] =
      instant_before(sample.stamp, joints->age + kJointDelay, belief.state, imu);
  const auto model = [&](const LegVelocity& legs, double variance) {
    return leg_velocity_model(state, rig_.T_body_base, motion.angular_velocity, legs,
                              variance * Eigen::Matrix3d::Identity());
  };
  const LinearMeasurement prediction = model({}, 0.0);
  const Eigen::Vector3d predicted = prediction.residual;
  const double predicted_variance =
      (prediction.jacobian * belief.covariance * prediction.jacobian.transpose()).trace() / 3.0;
  velocity_ = stride_means_.update(sample.stamp, predicted);

  const Eigen::Matrix3d R_base_body = rig_.T_body_base.R().transpose();
  const Eigen::Vector3d turning = R_base_body * (motion.angular_velocity - state.gyro_bias);
  const Eigen::Vector3d up = up_in_base(state, rig_.T_body_base);
  const FootVelocities feet =
      velocities_from_feet(*joints, compliance_.value(), turning, up, rig_.leg_geometry);
  const FootSelection select{contacts_of(sample), predicted, predicted_variance};
  const FootWeights weights = select.weights(feet);
  const double weight = total_weight(weights);
  if (weight == 0.0) return std::nullopt;
  velocity_.measured = mean_of_feet(feet, weights);
  const double variance = variance_of_feet(weight, rate_of(*joints));
  const LinearMeasurement measurement = model(velocity_, variance);

  if (compliance_.learns()) learn_compliance(*joints, turning, up, select, climb);
  return measurement;
}

}  // namespace aims
