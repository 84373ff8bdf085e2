// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/zero_velocity.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/leg_kinematics.hpp"

namespace aims {
namespace {

/// Longest gap between packets that the smoothing bridges.
constexpr Duration kMaxGap = 100 * kMillisecond;

/// Largest mean angular rate and deviation from it [rad/s], and largest deviation of the specific
/// force from its mean [m/s^2], of a standing robot, beyond white noise.
constexpr double kMaxRate = 0.03;
constexpr double kMaxForceDeviation = 0.3;

/// Largest speed from leg odometry [m/s] and root mean square rate of the joints [rad/s] of a
/// standing robot, smoothed with this time constant [s].
constexpr double kMaxLegSpeed = 0.02;
constexpr double kMaxJointRate = 0.15;
constexpr double kLegSmoothing = 0.05;

/// Factor on the limits once the robot stands.
constexpr double kHysteresis = 1.5;

/// Largest norm that white noise of deviation 1 per axis reaches: 99.9 % of the samples.
constexpr double kLargestNoise = 4.0;

}  // namespace

void describe(Fields& f, ZeroVelocityConfig& c) {
  f.flag("enabled", c.enabled, {"", any(), "zero-velocity update while the robot stands still"});
}

std::optional<ImuStatistics> imu_statistics(std::span<const ImuSample> samples, Time end,
                                            Duration window) {
  ImuStatistics statistics;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  int count = 0;
  auto first = samples.end();
  for (; first != samples.begin() && std::prev(first)->stamp > end - window; --first) {
    const ImuSample& sample = *std::prev(first);
    if (sample.stamp > end) continue;
    statistics.rate += sample.angular_velocity;
    force += sample.specific_force;
    ++count;
  }
  if (count < 3 || first == samples.begin()) return std::nullopt;
  statistics.rate /= count;
  force /= count;
  for (auto each = first; each != samples.end() && each->stamp <= end; ++each) {
    statistics.rate_deviation =
        std::max(statistics.rate_deviation, (each->angular_velocity - statistics.rate).norm());
    statistics.force_deviation =
        std::max(statistics.force_deviation, (each->specific_force - force).norm());
  }
  return statistics;
}

LinearMeasurement zero_velocity_model(const NominalState& state, double sigma) {
  using E = ErrorState;
  const Eigen::Matrix3d R_body_odom = state.rotation.conjugate().toRotationMatrix();
  LinearMeasurement m;
  m.residual = R_body_odom * state.velocity;
  columns(m.jacobian, E::kRotation) = hat(m.residual);
  columns(m.jacobian, E::kVelocity) = R_body_odom;
  m.noise = sigma * sigma * Eigen::Matrix3d::Identity();
  return m;
}

LinearMeasurement zero_rate_model(const NominalState& state, const Eigen::Vector3d& rate,
                                  double sigma) {
  LinearMeasurement m;
  m.residual = state.gyro_bias - rate;
  columns(m.jacobian, ErrorState::kGyroBias).setIdentity();
  m.noise = sigma * sigma * Eigen::Matrix3d::Identity();
  return m;
}

/// Three feet are in contact, since the load of one may be lost, or none is, and the smoothed
/// speeds of joints and base are small.
bool ZeroVelocityDetector::legs_still(const LegOdometrySample& legs, double factor) {
  const bool gap = !last_ || legs.stamp - *last_ > kMaxGap;
  const double dt = gap ? 1.0 : to_seconds(legs.stamp - *last_) / kLegSmoothing;
  const double gain = std::clamp(dt, 0.0, 1.0);
  last_ = legs.stamp;
  const Eigen::Map<const JointVector> position(legs.joint_position.data());
  const Eigen::Map<const JointVector> rate(legs.joint_velocity.data());
  smoothed_velocity_ += gain * (legs.linear_velocity - smoothed_velocity_);
  smoothed_joint_square_ += gain * (rate.squaredNorm() / kJointCount - smoothed_joint_square_);
  const bool has_joints = !position.isZero(0.0);  // some recordings have no joints and contacts
  const auto standing = std::ranges::count(legs.contact, true);
  const bool may_stand = !has_joints || standing >= 3 || standing == 0;
  return !gap && may_stand && smoothed_velocity_.norm() <= factor * kMaxLegSpeed &&
         std::sqrt(smoothed_joint_square_) <= factor * kMaxJointRate;
}

/// The samples of the window deviate no more than the limits and white noise allow.
bool ZeroVelocityDetector::imu_still(const Eigen::Vector3d& gyro_bias, double factor) const {
  if (!statistics_) return false;
  const double max_rate = factor * (kMaxRate + kLargestNoise * quiet_->rate);
  const double max_force = factor * (kMaxForceDeviation + kLargestNoise * quiet_->force);
  return statistics_->rate_deviation <= max_rate && statistics_->force_deviation <= max_force &&
         (statistics_->rate - gyro_bias).norm() <= max_rate;
}

bool ZeroVelocityDetector::update(const LegOdometrySample& legs, std::span<const ImuSample> imu,
                                  const Eigen::Vector3d& gyro_bias, const WhiteDeviation& white) {
  const double factor = standing_ ? kHysteresis : 1.0;
  if (!quiet_) quiet_ = white;
  quiet_ = {std::min(quiet_->rate, white.rate), std::min(quiet_->force, white.force)};
  statistics_ = imu_statistics(imu, legs.stamp, kStandingWindow);
  if (!legs_still(legs, factor) || !imu_still(gyro_bias, factor)) {
    still_since_.reset();
    standing_ = false;
    return false;
  }
  if (!still_since_) still_since_ = legs.stamp;
  standing_ = standing_ || legs.stamp - *still_since_ >= kStandingWindow;
  return standing_;
}

std::optional<ImuStatistics> ZeroVelocityDetector::due_measurement() {
  if (!standing_ || !last_) return std::nullopt;
  if (last_measured_ && *last_ - *last_measured_ < kStandingWindow) {
    return std::nullopt;
  }
  last_measured_ = last_;
  return statistics_;
}

}  // namespace aims
