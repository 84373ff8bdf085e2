// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/eskf_estimator.hpp"

#include "estimator/filter/imu_propagation.hpp"
#include "estimator/filter/initialization.hpp"
#include "estimator/legs/leg_states.hpp"
#include "estimator/legs/leg_velocity_model.hpp"
#include "estimator/lidar/deskew.hpp"

namespace aims {
namespace {

/// What the filter says of its pose error, in body axes; `anchor` is the covariance of the map.
void record_covariance(const Belief& belief, const Eigen::Matrix3d& anchor,
                       ScanDiagnostics& diagnostics) {
  using E = ErrorState;
  const Eigen::Matrix3d R = belief.state.rotation.toRotationMatrix();
  const Eigen::Matrix3d position = block(belief.covariance, E::kPosition, E::kPosition) + anchor;
  diagnostics.position_covariance = R.transpose() * position * R;
  diagnostics.rotation_covariance = block(belief.covariance, E::kRotation, E::kRotation);
}

}  // namespace

EskfEstimator::EskfEstimator(const EstimatorConfig& config, const FamilyMember& member,
                             const SensorRig& rig)
    : config_(config_of(member, config)),
      member_(member),
      rig_(rig),
      queue_(config_),
      selection_(config_.lidar),
      lidar_update_(config_, member),
      map_(config_.map),
      floor_(config_.directional.floor),
      leg_evidence_(config_.directional.leg_evidence, config_.leg),
      standstill_(config_.directional.standstill) {}

void EskfEstimator::consume(const Delivery& delivery) {
  queue_.push(delivery);
  process_ready();
}

void EskfEstimator::finish() {
  queue_.close();
  process_ready();
}

void EskfEstimator::process_ready() {
  if (started_ || start()) {
    while (const std::optional<Correction> next = queue_.pop()) {
      std::visit([this](const auto& each) { correct(each); }, *next);
    }
  }
  for (const auto& [name, count] : queue_.counts()) result_.counts[name] = count;
}

bool EskfEstimator::start() {
  const auto& samples = queue_.imu().samples();
  const StartConfig& quiet = config_.directional.start;
  const auto initial =
      quiet.enabled
          ? initialize_quietly(samples, config_.initialization, quiet, config_.imu.gravity)
          : initialize(samples, config_.initialization, config_.imu.gravity);
  if (!initial) return false;
  if (!initial->stood_still) ++result_.counts["start.moving"];
  belief_ = initial->belief;
  belief_ = open_leg_states(belief_, config_.directional.leg_states);
  if (config_.directional.floor.enabled) {
    belief_ = join_tilt_and_bias(belief_, config_.imu.gravity);
  }
  time_ = initial->stamp;
  started_ = true;
  return true;
}

void EskfEstimator::correct(const LegOdometrySample& sample) {
  if (!member_.leg) return bridge_silence(sample.stamp);
  if (sample.stamp < time_) {
    ++result_.counts["leg.before_start"];
    return;
  }
  const Duration period = from_seconds(1.0 / config_.leg.rate_hz);
  if (last_leg_) {
    const auto lost = static_cast<int>((sample.stamp - last_leg_->stamp - period / 2) / period);
    if (lost > 0) result_.counts["leg.lost"] += lost;
  }
  hold_lost_legs(sample.stamp);
  fuse_leg_velocity(sample);
  last_leg_ = sample;
  bridge_silence(sample.stamp);
}

/// Without scans the pose goes on by what there is; the legs' packets serve as its clock.
void EskfEstimator::bridge_silence(Time stamp) {
  if (result_.trajectory.empty()) return;
  if (stamp - result_.trajectory.back().stamp < kLongestSilence) return;
  predict_to(stamp);
  result_.trajectory.push_back({stamp, belief_.state.T_odom_body()});
  ++result_.counts["pose.without_scan"];
}

void EskfEstimator::hold_lost_legs(Time until) {
  if (!member_.hold_lost || !last_leg_) return;
  const Duration period = from_seconds(1.0 / config_.leg.rate_hz);
  while (last_leg_->stamp + period + period / 2 < until) {
    last_leg_->stamp += period;
    fuse_leg_velocity(*last_leg_);
    ++result_.counts["leg.held"];
  }
}

/// Covariance of one sample; `rate` is the gyro's reading in body axes [rad/s].
Eigen::Matrix3d EskfEstimator::leg_noise(const LegOdometrySample& sample,
                                         const Eigen::Vector3d& rate) {
  if (config_.directional.leg_evidence.enabled) {
    const Eigen::Matrix3d R_base_body = rig_.T_body_base.R().transpose();
    return leg_evidence_.noise(sample, R_base_body * (rate - belief_.state.gyro_bias));
  }
  // eq. (11): R_leg' = R_leg / gamma_leg.
  return leg_velocity_noise(config_.leg, sample.linear_velocity) / lidar_update_.gamma_leg();
}

/// Whether the robot stands still; then that it does is what its legs have to say. The states of
/// the legs are left alone: they are those of a walk.
bool EskfEstimator::stands(const LegOdometrySample& sample) {
  const StandstillConfig& config = config_.directional.standstill;
  if (!config.enabled) return false;
  if (!standstill_.observe(sample, queue_.imu().samples(), belief_.state.gyro_bias)) return false;
  const std::optional<ImuRest> rest = standstill_.due();
  if (!rest) return true;
  ++result_.counts["standstill.used"];
  Information information = information_of(zero_velocity(belief_.state, config.sigma_velocity));
  const Information bias =
      information_of(resting_gyro(belief_.state, rest->rate, config.sigma_rate));
  information.matrix += bias.matrix;
  information.vector += bias.vector;
  accept(kalman_update(belief_.state, inverse_spd(belief_.covariance), belief_.state, information,
                       hold_legs(correct_all())));
  return true;
}

void EskfEstimator::fuse_leg_velocity(const LegOdometrySample& sample) {
  predict_to(sample.stamp);
  if (stands(sample)) return;
  const Eigen::Vector3d rate =
      queue_.imu().angular_velocity_at(sample.stamp).value_or(belief_.state.gyro_bias);
  const LegVelocity legs{sample.linear_velocity, stride_mean_.update(sample)};
  LinearMeasurement measurement =
      leg_velocity_model(belief_.state, rig_.T_body_base, rate, legs, leg_noise(sample, rate));
  if (config_.directional.leg_evidence.enabled) {
    const auto inflation = leg_evidence_.inflation(measurement, belief_.covariance);
    if (!inflation) {
      ++result_.counts["leg.refused"];
      return;
    }
    measurement.noise *= *inflation;
  }
  leg_innovation_ = measurement.residual.norm();
  ++leg_updates_;
  const ErrorMatrix prior_information = inverse_spd(belief_.covariance);
  const Information information = information_of(measurement);
  accept(lidar_update_.holds_legs()
             ? kalman_update(belief_.state, prior_information, belief_.state, information,
                             hold_position(hold_legs(correct_all())))
             : kalman_update(belief_.state, prior_information, belief_.state, information));
}

void EskfEstimator::correct(const LidarScanPtr& scan) {
  if (scan->end < time_) {
    ++result_.counts["lidar.before_start"];
    return;
  }
  hold_lost_legs(scan->end);
  predict_to(scan->end);
  ScanDiagnostics diagnostics;
  diagnostics.stamp = scan->end;
  diagnostics.leg_innovation = leg_innovation_;
  diagnostics.leg_updates = leg_updates_;
  leg_updates_ = 0;
  prepare_points(*scan, diagnostics);
  if (config_.directional.floor.enabled) fuse_floor();
  if (!map_.empty()) {
    accept(lidar_update_.update(belief_, match_points_, map_, diagnostics));
    if (diagnostics.iterations == 0) ++result_.counts["lidar.no_update"];
  }
  extend_map();
  record_covariance(belief_, lidar_update_.map_anchor(), diagnostics);
  result_.trajectory.push_back({scan->end, belief_.state.T_odom_body()});
  result_.diagnostics.push_back(diagnostics);
}

void EskfEstimator::predict_to(Time stamp) {
  if (stamp <= time_) return;
  queue_.imu().segments(time_, stamp, segments_);
  for (const InertialSegment& segment : segments_) {
    const double dt = to_seconds(segment.end - segment.begin);
    accept(propagate(belief_, segment, dt, config_.imu));
    if (!segment.measured) ++result_.counts["imu.bridged"];
  }
  walk_leg_states(belief_, config_.directional.leg_states, to_seconds(stamp - time_));
  time_ = stamp;
  queue_.imu().forget_before(stamp - kSecond);
}

void EskfEstimator::prepare_points(const LidarScan& scan, ScanDiagnostics& diagnostics) {
  for (const LidarPoint& point : scan.points) diagnostics.points_in += selection_.usable(point);
  queue_.imu().segments(scan.stamp, scan.end, segments_);
  const ScanMotion motion(belief_.state, segments_, rig_.T_body_lidar, config_.imu.gravity);
  selection_.select(scan, config_.lidar.selection_voxel, config_.lidar.max_points, indices_);
  deskew(scan, indices_, motion, match_points_);
  selection_.select(scan, config_.map.insertion_voxel, config_.map.max_insertions, indices_);
  deskew(scan, indices_, motion, insert_points_);
}

/// The floor of this scan, as long as it is level.
void EskfEstimator::fuse_floor() {
  const auto seen = fit_floor(insert_points_, config_.directional.floor);
  const auto measurement = floor_.measure(belief_, seen);
  if (floor_.verdict() == FloorVerdict::kUnseen) ++result_.counts["floor.unseen"];
  if (floor_.verdict() == FloorVerdict::kNotLevel) ++result_.counts["floor.not_level"];
  if (floor_.verdict() == FloorVerdict::kWaiting) ++result_.counts["floor.waiting"];
  if (!measurement) return;
  ++result_.counts["floor.used"];
  accept(aims::fuse_floor(belief_, *measurement));
}

void EskfEstimator::extend_map() {
  const Eigen::Matrix3f R = belief_.state.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f t = belief_.state.position.cast<float>();
  for (Eigen::Vector3f& point : insert_points_) point = R * point + t;
  const Eigen::Matrix3d position =
      block(belief_.covariance, ErrorState::kPosition, ErrorState::kPosition);
  map_.insert(insert_points_, t, (position + lidar_update_.map_anchor()).cast<float>());
  const MapMemoryConfig& memory = config_.directional.map_memory;
  if (!memory.enabled) map_.forget_unseen(memory.forget_after);
}

bool EskfEstimator::accept(const Belief& updated) {
  const bool sound = is_finite(updated.state) && updated.covariance.allFinite() &&
                     (updated.covariance.diagonal().array() > 0.0).all();
  if (sound) {
    belief_ = updated;
  } else {
    ++result_.counts["filter.refused"];
  }
  return sound;
}

}  // namespace aims
