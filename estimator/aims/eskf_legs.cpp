// SPDX-License-Identifier: BSD-3-Clause
// The part of EskfEstimator that fuses leg packets.
#include <algorithm>
#include <cmath>

#include "estimator/aims/eskf_estimator.hpp"
#include "estimator/legs/leg_velocity_model.hpp"

namespace aims {
namespace {

/// Noise of the legs until their scale is known, 0.1 m/s and 5 %: large enough that the error of
/// the scale does not keep scans from fitting each other (docs/decisions.md).
const LegConfig kLegsOfUnknownScale;

/// Without a scan for longer, nothing but the legs may measure the velocity.
constexpr Duration kScanIsRecent = kSecond / 2;

/// What measures the state besides the feet.
struct MeasuredByScans {
  bool pose = false;  ///< by scans up to now
  bool scale_of_feet = false;
};

/// What feet correct. Not heading and gyro bias: unmodelled creep and rolling would turn the robot.
/// The leg scale only where scans measure the velocity; elsewhere changes of speed would decide it.
/// Without scans neither the level bias of the accelerometer, which would tilt the robot, nor the
/// height: the errors of feet within a stride repeat, and would be taken for an old error of it
/// (docs/decisions.md#feet-alone-keep-tilt-and-height).
GainMask gain_of_feet(const NominalState& state, const MeasuredByScans& measured) {
  const Eigen::Vector3d up = state.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  GainMask mask;
  mask.legs = measured.scale_of_feet;
  mask.gyro_bias = false;
  mask.rotation -= up * up.transpose();
  if (!measured.pose) {
    mask.accelerometer_bias = up * up.transpose();
    mask.height = false;
  }
  return mask;
}

/// The covariance of a sample at `rate_hz`, at least that of white noise of that density.
Eigen::Matrix3d with_density(const Eigen::Matrix3d& noise, const Eigen::Vector3d& density,
                             double rate_hz) {
  const Eigen::Vector3d variance = noise.diagonal().cwiseMax(rate_hz * density);
  return variance.asDiagonal();
}

}  // namespace

void EskfEstimator::process_legs(const LegOdometrySample& sample) {
  last_correction_ = sample.stamp;
  if (!config_.legs.enabled) return report_pose_without_scan(sample.stamp);
  if (sample.stamp < time_) return count_behind("leg", sample.stamp);
  const Duration period = from_seconds(1.0 / rig_.leg_rate_hz);
  if (!last_leg_) meet_legs(feet_.applies(sample));
  if (last_leg_) {
    const auto lost = static_cast<int>((sample.stamp - last_leg_->stamp - period / 2) / period);
    if (lost > 0) result_.counts["leg.lost"] += lost;
  }
  repeat_lost_legs(sample.stamp);
  fuse_leg_velocity(sample);
  last_leg_ = sample;
  report_pose_without_scan(sample.stamp);
}

/// The scale of legs that are measured foot by foot is known to 4 %, and that of a calibrated robot
/// better: well enough to map from the estimate. Only reported velocities need the second belief.
void EskfEstimator::meet_legs(bool by_feet) {
  belief_ = robot_.at_first_legs(belief_, by_feet);
  if ((by_feet || robot_.legs_are_known()) && !measures_legs(config_)) mapping_.reset();
}

/// Zero-order hold of lost leg packets, for the variant that does not notice the loss.
void EskfEstimator::repeat_lost_legs(Time until) {
  if (!config_.legs.repeat_lost || !last_leg_) return;
  const Duration period = from_seconds(1.0 / rig_.leg_rate_hz);
  while (last_leg_->stamp + period + period / 2 < until) {
    last_leg_->stamp += period;
    fuse_leg_velocity(*last_leg_);
    ++result_.counts["leg.held"];
  }
}

/// The velocity that the robot reports, with the covariance of eq. (11), which is larger until the
/// leg scale is known.
LinearMeasurement EskfEstimator::reported_velocity(const LegOdometrySample& sample) {
  const LegConfig& legs = mapping_ ? kLegsOfUnknownScale : config_.legs;
  const Eigen::Matrix3d nominal =
      leg_velocity_noise(legs, rig_.leg_rate_hz, belief_.state.velocity.norm());
  const Eigen::Matrix3d noise = with_density(nominal, velocity_noise_.density(), rig_.leg_rate_hz) /
                                lidar_update_.gamma_leg();
  const Eigen::Vector3d rate =
      queue_.imu().angular_velocity_at(sample.stamp).value_or(belief_.state.gyro_bias);
  velocity_ = stride_means_.update(sample.stamp, sample.linear_velocity);
  const NominalState& state = belief_.state;
  velocity_noise_.add(sample.stamp, state.rotation * rig_.T_body_base.rotation *
                                        (velocity_.measured - state.leg_bias -
                                         state.leg_scale.cwiseProduct(velocity_.stride_mean)));
  return leg_velocity_model(belief_.state, rig_.T_body_base, rate, velocity_, noise);
}

/// While the robot stands, zero velocity and zero rate replace the leg velocity; true then. The leg
/// states are not corrected, since they describe walking.
bool EskfEstimator::fuse_zero_velocity(const LegOdometrySample& sample) {
  if (!config_.zero_velocity.enabled) return false;
  const bool standing = zero_velocity_.update(
      sample, queue_.imu().samples(), belief_.state.gyro_bias, queue_.imu().noise().white());
  if (!standing) return false;
  const std::optional<ImuStatistics> statistics = zero_velocity_.due_measurement();
  if (!statistics) return true;
  ++result_.counts["zero_velocity.used"];
  fuse_standing(statistics->rate);
  return true;
}

/// Zero velocity and zero rate; `rate` is the mean reading of the gyro, body axes [rad/s].
void EskfEstimator::fuse_standing(const Eigen::Vector3d& rate) {
  const GainMask without_legs{.legs = false};
  const auto still = [](const Belief& belief) {
    return zero_velocity_model(belief.state, kSigmaZeroVelocity);
  };
  const auto not_turning = [&](const Belief& belief) {
    return zero_rate_model(belief.state, rate, kSigmaZeroRate);
  };
  accept(belief_, lidar_update_.fuse_velocity(belief_, still(belief_), without_legs));
  accept(belief_, lidar_update_.fuse_velocity(belief_, not_turning(belief_), without_legs));
  if (!mapping_) return;
  accept(*mapping_, fuse(*mapping_, still(*mapping_), without_legs));
  accept(*mapping_, fuse(*mapping_, not_turning(*mapping_), without_legs));
}

/// Only with the final compliance of the joints: a scale learned before would be wrong later.
bool EskfEstimator::scans_measure_scale_of_feet() const {
  return feet_.compliance().is_learned() && lidar_update_.constrains_all_directions() &&
         last_scan_ && time_ - *last_scan_ < kScanIsRecent;
}

/// Relative excess of the variance of the feet's scale over that of the belief, because joints are
/// soft. It is only stated: in the belief it would move the estimate without a measurement.
double EskfEstimator::excess_of_soft_joints() const {
  if (!last_leg_ || !feet_.applies(*last_leg_) || robot_.judges_legs()) return 0.0;
  const double sigma = feet_scale_sigma(feet_.compliance().part_of_way()) / kFeetScaleSigma;
  return sigma * sigma - 1.0;
}

/// What soft joints add to the covariance of the position, odometry axes [m^2].
Eigen::Matrix3d EskfEstimator::covariance_of_soft_joints() const {
  const double excess = excess_of_soft_joints();
  return excess > 0.0 ? Eigen::Matrix3d(excess * position_covariance_by_leg_scale(belief_))
                      : Eigen::Matrix3d::Zero();
}

/// Deviation of the scale of legs on soft joints, smaller once scans have measured it; 0 on stiff
/// ones.
double EskfEstimator::sigma_of_soft_legs() const {
  const double excess = excess_of_soft_joints();
  const int scale = ErrorState::kLegScale.offset;
  const double variance = stated_covariance(belief_)(scale, scale);
  return excess > 0.0 ? std::sqrt((1.0 + excess) * variance) : 0.0;
}

/// The start counts as a scan: the first one follows.
bool EskfEstimator::has_scans() const { return last_scan_ || time_ - begin_ < kScanIsRecent; }

void EskfEstimator::fuse_leg_velocity(const LegOdometrySample& sample) {
  predict_to(sample.stamp);
  const bool by_feet = feet_.applies(sample);
  const std::optional<LinearMeasurement> feet =
      by_feet ? feet_.measure(sample, belief_, queue_.imu()) : std::nullopt;
  if (fuse_zero_velocity(sample) || (by_feet && !feet)) return;
  const LinearMeasurement measurement = by_feet ? *feet : reported_velocity(sample);
  const LegVelocity& legs = by_feet ? feet_.velocity() : velocity_;
  health_.leg_residual(uncorrected_residual(measurement, belief_.state, legs));
  leg_innovation_ = measurement.residual.norm();
  ++leg_updates_;
  const GainMask mask =
      by_feet ? gain_of_feet(belief_.state, {has_scans(), scans_measure_scale_of_feet()})
              : GainMask();
  const bool judged = mask.legs && !lidar_update_.considers_legs() && robot_.judges_legs();
  const std::optional<Belief> before = judged ? std::optional(belief_) : std::nullopt;
  const MotionVariance predicted = motion_variance(belief_);
  accept(belief_, lidar_update_.fuse_velocity(belief_, measurement, mask));
  taken_by_legs_ += predicted - motion_variance(belief_);
  if (before) robot_.after_legs(*before, belief_);
  if (!mapping_) return;
  accept(*mapping_, fuse(*mapping_, moved_to(measurement, belief_.state, mapping_->state), mask));
}

}  // namespace aims
