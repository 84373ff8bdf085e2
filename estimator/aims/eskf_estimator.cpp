// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/eskf_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "estimator/filter/imu_propagation.hpp"
#include "estimator/filter/outage.hpp"
#include "estimator/filter/static_initialization.hpp"

namespace aims {
namespace {

/// The stated pose covariance in body axes: that of the filter plus `others` of the position
/// (odometry axes) [m^2] and the deviation `sigma_attitude` per axis [rad].
void record_covariance(const Belief& belief, const Eigen::Matrix3d& others, double sigma_attitude,
                       ScanDiagnostics& diagnostics) {
  using E = ErrorState;
  const Eigen::Matrix3d R = belief.state.rotation.toRotationMatrix();
  const ErrorMatrix P = stated_covariance(belief);
  const Eigen::Matrix3d position = block(P, E::kPosition, E::kPosition) + others;
  diagnostics.covariance.position = R.transpose() * position * R;
  diagnostics.covariance.rotation = block(P, E::kRotation, E::kRotation);
  diagnostics.covariance.rotation.diagonal().array() += sigma_attitude * sigma_attitude;
}

/// Without corrections for longer, the IMU is the clock of the poses.
constexpr Duration kCoastAfter = kSecond;

/// Faster than any legged robot walks [m/s]. Without fusion, leg packets are only a clock: none is
/// out of range.
double max_leg_speed(const EskfConfig& config) {
  return config.legs.enabled ? 5.0 : std::numeric_limits<double>::infinity();
}

/// Without fusion, the leg states stay fixed.
LegStatesConfig leg_states_of(const EskfConfig& config) {
  return config.legs.enabled ? config.leg_states : LegStatesConfig();
}

}  // namespace

EskfEstimator::EskfEstimator(const EskfConfig& config, const SensorRig& rig,
                             std::unique_ptr<const ScanRule> rule)
    : QueuedEstimator(config.queue, rig, scan_series(), max_leg_speed(config), config.imu),
      config_(config),
      points_(config_.lidar, config_.map, rig.T_body_lidar.translation),
      lidar_update_(config_, std::move(rule)),
      leg_free_(config_.imu),
      map_(config_.map),
      ground_(config_.ground_constraint),
      health_({.lidar = config_.lidar.enabled, .legs = config_.legs.enabled, .imu = true},
              config_.imu.gravity),
      robot_(config_, rig.imu_rate_hz),
      feet_(config_.feet, rig, config_.imu.gravity,
            config_.lidar.enabled ? VerticalReference::kHeight : VerticalReference::kLevelGround) {
  if (const auto known_compliance = known(config_.prior, "joint_compliance")) {
    feet_.compliance().know(known_compliance->mean(0),
                            std::sqrt(known_compliance->covariance(0, 0)));
  }
}

void EskfEstimator::consume(const Delivery& delivery) {
  QueuedEstimator::consume(delivery);
  if (!judged_ || *queue_.now() - *judged_ >= HealthMonitor::kInterval) {
    append_health(result_.health, judged_health());
  }
}

void EskfEstimator::finish() {
  QueuedEstimator::finish();
  if (queue_.now()) close_health(result_.health, judged_health());
}

bool EskfEstimator::start() {
  if (started_) return true;
  const auto& samples = queue_.imu().samples();
  const auto initial = config_.static_initialization.enabled
                           ? initialize_static(samples, config_.initialization, config_.imu.gravity)
                           : initialize(samples, config_.initialization, config_.imu.gravity);
  if (!initial) return false;
  stood_still_ = initial->stood_still;
  if (!stood_still_) ++result_.counts["initialization.moving"];
  belief_ = open_leg_states(initial->belief, leg_states_of(config_));
  belief_ = open_calibration(belief_, estimated_calibration(config_), rig_.imu_rate_hz);
  belief_ = robot_.at_start(belief_);
  queue_.imu().set_delay(from_seconds(belief_.state.delay));
  if (config_.lidar.enabled && config_.cross_validation.enabled) mapping_ = belief_;
  time_ = begin_ = initial->stamp;
  first_belief_ = belief_;
  last_pose_ = time_;
  last_correction_ = time_;
  started_ = true;
  return true;
}

/// Appends a predicted pose after `kMaxPoseInterval` without a scan; leg packets are the clock.
void EskfEstimator::report_pose_without_scan(Time stamp) {
  if (stamp - last_pose_ < kMaxPoseInterval) return;
  predict_to(stamp);
  leg_free_.predict_to(stamp, queue_.imu());
  report_pose(stamp);
  ++result_.counts["pose.without_scan"];
}

void EskfEstimator::report_pose(Time stamp) {
  result_.trajectory.push_back({stamp, belief_.state.T_odom_body()});
  last_pose_ = stamp;
}

/// Of a measurement before the belief: from before its start, or of a silence that the IMU alone
/// has bridged, as when legs and scans wait longer than it.
void EskfEstimator::count_behind(const char* sensor, Time stamp) {
  ++result_.counts[std::string(sensor) + (stamp < begin_ ? ".before_start" : ".after_prediction")];
}

/// While neither legs nor scans arrive, IMU samples are the clock of the predicted poses.
void EskfEstimator::coast() {
  const std::optional<Time> newest = queue_.imu().newest();
  if (newest && *newest - last_correction_ >= kCoastAfter) report_pose_without_scan(*newest);
}

HealthRow EskfEstimator::judged_health() {
  judged_ = queue_.now();
  if (!started_) return health_.judge(*judged_, queue_.inputs(), std::nullopt);
  // Soft joints degrade health for a reason of their own. The deviation that they add is an upper
  // bound, so it must not make an estimate invalid.
  HealthEstimate estimate = health_estimate(belief_);
  estimate.soft_leg_sigma = sigma_of_soft_legs();
  HealthRow row = health_.judge(*judged_, queue_.inputs(), estimate);
  row.position_sigma = health_estimate(belief_, covariance_of_soft_joints()).position_sigma;
  return row;
}

/// The pipeline of one scan. Leg packets since the last scan have corrected the belief at their own
/// stamps (eskf_legs.cpp); `leg_free_` is the prediction without them, for C_IL of eq. (6).
void EskfEstimator::process_scan(const LidarScanPtr& scan) {
  last_correction_ = scan->end;
  if (scan->end < time_) return count_behind("lidar", scan->end);
  repeat_lost_legs(scan->end);
  predict_to(scan->end);
  if (!config_.lidar.enabled) return report_pose(scan->end);
  leg_free_.predict_to(scan->end, queue_.imu());
  ScanDiagnostics diagnostics = diagnostics_of_prediction();
  prepare_points(*scan, diagnostics);
  if (!map_.empty()) fuse_scan(diagnostics);
  if (config_.ground_constraint.enabled) fuse_ground_constraint();
  extend_map();
  points_.keep(matched_pose());
  report_pose(scan->end);
  record_scan(diagnostics);
}

ScanDiagnostics EskfEstimator::diagnostics_of_prediction() {
  ScanDiagnostics diagnostics;
  diagnostics.stamp = time_;
  diagnostics.leg_innovation = leg_innovation_;
  diagnostics.leg_updates = std::exchange(leg_updates_, 0);
  diagnostics.imu_noise = queue_.imu().noise().density();
  return diagnostics;
}

void EskfEstimator::record_scan(ScanDiagnostics& diagnostics) {
  if (mapping_) ++result_.counts["map.before_legs_known"];
  health_.scan(diagnostics, points_.to_match().size());
  last_scan_ = time_;
  leg_free_.restart(matching(), time_);
  velocity_noise_.at_scan(time_, belief_.state.T_odom_body() * rig_.T_body_base,
                          diagnostics.iterations > 0 && lidar_update_.constrains_all_directions());
  diagnostics.delay = belief_.state.delay;
  diagnostics.mount = so3_log(belief_.state.mount);
  const Eigen::Matrix3d rig = rig_covariance(first_belief_.state.T_odom_body(),
                                             belief_.state.T_odom_body(), config_.calibration);
  record_covariance(belief_, lidar_update_.map_covariance() + rig + covariance_of_soft_joints(),
                    sigma_of_fixed_mount(config_), diagnostics);
  result_.diagnostics.scans.push_back(row_of(diagnostics));
}

void EskfEstimator::count_scan(const ScanDiagnostics& diagnostics) {
  if (diagnostics.relocated) ++result_.counts["lidar.relocated"];
  if (diagnostics.verdict.rotation) ++result_.counts["lidar.unconstrained_rotation"];
  if (diagnostics.verdict.translation) ++result_.counts["lidar.unconstrained_translation"];
  if (diagnostics.verdict.partial) ++result_.counts["lidar.partly_constrained"];
}

/// Fuses the prepared points, and learns from the correction how noisy the IMU is.
void EskfEstimator::fuse_scan(ScanDiagnostics& diagnostics) {
  silence_ = 0.0;
  if (outage_ > 0.0) find_heading();
  const Belief predicted = belief_;
  const MotionVariance by_legs = std::exchange(taken_by_legs_, {});
  lidar_update_.hold_legs(!legs_are_final());
  const ScanPart part = mapping_ ? ScanPart::kAll : ScanPart::kReal;
  accept(matching(), lidar_update_.update(matching(), points_.to_match(), map_, calibration_, part,
                                          diagnostics, leg_free_.belief()));
  if (diagnostics.iterations == 0) {
    ++result_.counts["lidar.no_update"];
    return;
  }
  count_scan(diagnostics);
  if (mapping_) accept(belief_, lidar_update_.update_with_real_part(belief_, map_));
  const double since_last = last_scan_ ? to_seconds(time_ - *last_scan_) : 0.0;
  accept(belief_, robot_.after_scan(predicted, belief_, since_last));
  note_contradictions();
  if (last_scan_) {
    const ErrorVector y = boxminus(belief_.state, predicted.state);
    // Across the robot only: along it a corridor may leave the velocity free.
    const Eigen::Vector3d across =
        belief_.state.rotation.conjugate() * segment(y, ErrorState::kVelocity);
    queue_.imu().noise().add_correction(
        segment(y, ErrorState::kRotation).squaredNorm() / 3.0 + by_legs.rotation,
        across.tail<2>().squaredNorm() / 2.0 + by_legs.velocity, since_last);
  }
  apply_calibration();
  if (measures_legs(config_) && mapping_ && last_leg_ && legs_are_final()) {
    robot_.compare_legs(belief_.state, mapping_->state, since_last,
                        lidar_update_.constrains_the_way(mapping_->state));
  }
  if (legs_are_known()) mapping_.reset();
}

/// States what of the robot's calibration this run contradicts.
void EskfEstimator::note_contradictions() {
  for (const std::string& name : robot_.take_contradictions()) {
    ++result_.counts["calibration.contradicted." + name];
    health_.calibration_contradicted();
  }
  const bool compliance = feet_.compliance().contradicted();
  if (!compliance || result_.counts.contains("calibration.contradicted.joint_compliance")) return;
  ++result_.counts["calibration.contradicted.joint_compliance"];
  health_.calibration_contradicted();
}

std::vector<LearnedQuantity> EskfEstimator::learned() const {
  return robot_.learned(belief_, feet_.compliance());
}

/// Whether the errors of the legs are those that they will have to the end. A scale that is learned
/// before the compliance of the joints would be wrong later, and hide the height drift from which
/// the compliance is learned.
bool EskfEstimator::legs_are_final() const {
  return !last_leg_ || !feet_.applies(*last_leg_) || feet_.compliance().is_learned();
}

/// Whether scans are mapped from the estimate: once the leg scale is known to 5 % and the scan
/// constrains every direction.
bool EskfEstimator::legs_are_known() const {
  const int scale = ErrorState::kLegScale.offset;
  return !lidar_update_.considers_legs() &&
         belief_.covariance(scale, scale) < kKnownLegScale * kKnownLegScale;
}

/// Applies the new mount and delay of the belief; the scan stays where it was matched.
void EskfEstimator::apply_calibration() {
  const Pose matched = matched_pose();
  const double delay = belief_.state.delay;
  belief_ = after_delay_change(belief_, delay - calibration_.delay, calibration_.twist);
  calibration_.delay = delay;
  queue_.imu().set_delay(from_seconds(delay));
  if (!mapping_) return;
  mapping_->state.mount = belief_.state.mount;
  mapping_->state.delay = delay;
  mapping_->state = at_scan_pose(mapping_->state, matched, calibration_);
}

void EskfEstimator::predict_to(Time stamp) {
  if (stamp <= time_) return;
  queue_.imu().observe_noise(stamp);
  queue_.imu().segments(time_, stamp, segments_);
  for (const InertialSegment& segment : segments_) {
    if (!segment.measured) ++result_.counts["imu.bridged"];
  }
  predict(belief_, to_seconds(stamp - time_));
  if (mapping_) predict(*mapping_, to_seconds(stamp - time_));
  note_outage();
  time_ = stamp;
  queue_.imu().forget_before(stamp - kSecond);
}

/// Over `segments_`, `duration` long [s].
void EskfEstimator::predict(Belief& belief, double duration) {
  for (const InertialSegment& segment : segments_) {
    const double dt = to_seconds(segment.end - segment.begin);
    accept(belief, is_outage(segment) ? after_outage(belief, dt)
                                      : propagate(belief, segment, dt, config_.imu));
  }
  const double walk = robot_.walk_of_legs();
  walk_leg_states(belief, leg_states_of(config_), walk * walk * duration);
  walk_calibration(belief, estimated_calibration(config_), duration);
}

void EskfEstimator::prepare_points(const LidarScan& scan, ScanDiagnostics& diagnostics) {
  queue_.imu().segments(scan.stamp, scan.end, segments_);
  calibration_ = {rig_.T_body_lidar.translation,
                  mean_twist(belief_.state, segments_, config_.imu.gravity), belief_.state.mount,
                  belief_.state.delay};
  scan_motion_.assign(belief_.state, segments_, corrected_mount(belief_.state, rig_.T_body_lidar),
                      config_.imu.gravity);
  points_.prepare(scan, scan_motion_, matching().state.T_odom_body());
  diagnostics.points_in = points_.in_range();
  if (points_.moving() > 0) result_.counts["lidar.moving"] += points_.moving();
  const LeftOutByRange left_out = points_.left_out(scan);
  if (left_out == LeftOutByRange::kTooNear) ++result_.counts["lidar.mostly_too_near"];
  if (left_out == LeftOutByRange::kTooFar) ++result_.counts["lidar.mostly_too_far"];
}

void EskfEstimator::fuse_ground_constraint() {
  const auto plane = fit_ground(points_.to_map(), ground_lists_);
  // The map has the tilt of the first belief, so matching scans in it cannot show that tilt.
  const bool hidden_tilt = plane && !levelled_ && !map_.empty() && near_start();
  const auto above_ground = [&](const Belief& belief, bool tilted_as_start) {
    const Belief above = with_map_error(belief, lidar_update_.map_covariance());
    return tilted_as_start ? with_tilt_of(above, first_belief_) : above;
  };
  const auto measurement = ground_.measure(above_ground(belief_, hidden_tilt), plane);
  if (ground_.status() == GroundStatus::kNotFound) ++result_.counts["ground.not_found"];
  if (ground_.status() == GroundStatus::kSloped) ++result_.counts["ground.not_level"];
  if (!measurement) return;
  ++result_.counts["ground.used"];
  if (ground_.start_was_sloped()) ++result_.counts["ground.start_was_sloped"];
  const bool level_start = hidden_tilt || ground_.start_was_sloped();
  const auto level = [&](Belief& belief, const LinearMeasurement& ground) {
    const Belief levelled = fuse_ground(above_ground(belief, level_start), ground);
    accept(belief,
           level_start ? with_turned_path(levelled, belief.state, first_belief_.state) : levelled);
  };
  const NominalState measured_at = belief_.state;
  level(belief_, *measurement);
  if (mapping_) level(*mapping_, moved_to(*measurement, measured_at, mapping_->state));
  ground_.corrected(belief_.state, level_start);
  levelled_ = true;
  if (level_start) forget_map();
}

/// Whether the robot is where the first level floor may be, on average.
bool EskfEstimator::near_start() const {
  return (belief_.state.position - first_belief_.state.position).norm() < kLevelDistance;
}

void EskfEstimator::forget_map() {
  ++result_.counts["map.restarted"];
  map_ = VoxelMap(config_.map);
  points_.forget();
}

void EskfEstimator::extend_map() {
  const Pose pose = matched_pose();
  const Eigen::Matrix3f R = pose.R().cast<float>();
  const Eigen::Vector3f t = pose.translation.cast<float>();
  mapped_.resize(points_.to_map().size());
  std::ranges::transform(points_.to_map(), mapped_.begin(),
                         [&](const Eigen::Vector3f& p) -> Eigen::Vector3f { return R * p + t; });
  const ErrorMatrix P = stated_covariance(belief_);
  const Eigen::Matrix3d position = block(P, ErrorState::kPosition, ErrorState::kPosition);
  const Eigen::Matrix3f covariance = (position + lidar_update_.map_covariance()).cast<float>();
  // The attitude of a start in motion is rough. With the first scan in both halves the second one
  // is matched and corrects it.
  const bool both_halves = map_.empty() && !stood_still_;
  map_.insert(mapped_, t, covariance);
  if (both_halves) map_.insert(mapped_, t, covariance);
}

void EskfEstimator::accept(Belief& belief, const Belief& updated) {
  // A sum is finite only if all of it is, and takes one pass of four lanes.
  const bool valid = is_finite(updated.state) && std::isfinite(stated_covariance(updated).sum()) &&
                     (updated.covariance.diagonal().array() > 0.0).all();
  if (valid) {
    belief = updated;
  } else {
    ++result_.counts["filter.rejected"];
    health_.not_finite();
  }
}

}  // namespace aims
