// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/standstill.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/leg_kinematics.hpp"

namespace aims {
namespace {

/// Packets further apart than this tell nothing about what lies between them.
constexpr Duration kLongestGap = 100 * kMillisecond;

}  // namespace

std::optional<ImuRest> imu_rest(const std::deque<ImuSample>& samples, Time end, Duration window) {
  ImuRest rest;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  int count = 0;
  auto first = samples.end();
  for (; first != samples.begin() && std::prev(first)->stamp > end - window; --first) {
    const ImuSample& sample = *std::prev(first);
    if (sample.stamp > end) continue;
    rest.rate += sample.angular_velocity;
    force += sample.specific_force;
    ++count;
  }
  if (count < 3 || first == samples.begin()) return std::nullopt;
  rest.rate /= count;
  force /= count;
  for (auto each = first; each != samples.end() && each->stamp <= end; ++each) {
    rest.rate_deviation =
        std::max(rest.rate_deviation, (each->angular_velocity - rest.rate).norm());
    rest.force_deviation = std::max(rest.force_deviation, (each->specific_force - force).norm());
  }
  return rest;
}

LinearMeasurement zero_velocity(const NominalState& state, double sigma) {
  using E = ErrorState;
  const Eigen::Matrix3d R_body_odom = state.rotation.conjugate().toRotationMatrix();
  LinearMeasurement m;
  m.residual = R_body_odom * state.velocity;
  columns(m.jacobian, E::kRotation) = hat(m.residual);
  columns(m.jacobian, E::kVelocity) = R_body_odom;
  m.noise = sigma * sigma * Eigen::Matrix3d::Identity();
  return m;
}

LinearMeasurement resting_gyro(const NominalState& state, const Eigen::Vector3d& rate,
                               double sigma) {
  LinearMeasurement m;
  m.residual = state.gyro_bias - rate;
  columns(m.jacobian, ErrorState::kGyroBias).setIdentity();
  m.noise = sigma * sigma * Eigen::Matrix3d::Identity();
  return m;
}

/// All feet stand, joints and base rest; noise of joints and velocity is smoothed away.
bool StandstillDetector::legs_rest(const LegOdometrySample& legs, double factor) {
  const bool gap = !last_ || legs.stamp - *last_ > kLongestGap;
  const double dt = gap ? 1.0 : to_seconds(legs.stamp - *last_) / config_.leg_smoothing;
  const double share = std::clamp(dt, 0.0, 1.0);
  last_ = legs.stamp;
  const Eigen::Map<const JointVector> position(legs.joint_position.data());
  const Eigen::Map<const JointVector> rate(legs.joint_velocity.data());
  smoothed_velocity_ += share * (legs.linear_velocity - smoothed_velocity_);
  smoothed_joint_square_ += share * (rate.squaredNorm() / kJointCount - smoothed_joint_square_);
  const bool told = !position.isZero(0.0);  // recordings may lack joints and contacts
  const bool all_stand =
      std::all_of(legs.contact.begin(), legs.contact.end(), [](bool stands) { return stands; });
  return !gap && (!told || all_stand) && smoothed_velocity_.norm() <= factor * config_.leg_speed &&
         std::sqrt(smoothed_joint_square_) <= factor * config_.joint_rate;
}

bool StandstillDetector::observe(const LegOdometrySample& legs, const std::deque<ImuSample>& imu,
                                 const Eigen::Vector3d& gyro_bias) {
  const double factor = standing_ ? config_.hysteresis : 1.0;
  rest_ = imu_rest(imu, legs.stamp, from_seconds(config_.window));
  const bool imu_rests = rest_ && rest_->rate_deviation <= factor * config_.rate &&
                         rest_->force_deviation <= factor * config_.force &&
                         (rest_->rate - gyro_bias).norm() <= factor * config_.rate;
  if (!legs_rest(legs, factor) || !imu_rests) {
    resting_since_.reset();
    standing_ = false;
    return false;
  }
  if (!resting_since_) resting_since_ = legs.stamp;
  standing_ = standing_ || legs.stamp - *resting_since_ >= from_seconds(config_.window);
  return standing_;
}

std::optional<ImuRest> StandstillDetector::due() {
  if (!standing_ || !last_) return std::nullopt;
  if (last_measured_ && *last_ - *last_measured_ < from_seconds(config_.window)) {
    return std::nullopt;
  }
  last_measured_ = last_;
  return rest_;
}

}  // namespace aims
