// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lins/robocentric_odometry.hpp"

#include <algorithm>

namespace aims::lins {
namespace {

/// Further from the start the pose is of no use [m].
constexpr double kMaxDistance = 1e6;

Inertial inertial(const ImuSample& sample) {
  return {sample.angular_velocity, sample.specific_force};
}

ErrorMatrix start_covariance(const FilterConfig& config) {
  ErrorVector deviations = ErrorVector::Zero();
  part(deviations, Error::kAccelerometerBias) << config.horizontal_force_bias,
      config.horizontal_force_bias, config.vertical_force_bias;
  part(deviations, Error::kGyroBias).setConstant(config.gyro_bias);
  part(deviations, Error::kGravity).setConstant(config.gravity);
  return deviations.cwiseAbs2().asDiagonal();
}

bool has(const features::RingFeatures& scan, int edges, int planes) {
  return static_cast<int>(scan.less_sharp.size()) >= edges &&
         static_cast<int>(scan.less_flat.size()) >= planes;
}

}  // namespace

/// Each sample stands for the time since the one before; the last one for the rest.
void RobocentricOdometry::predict(std::span<const ImuSample> samples, Time until) {
  for (const ImuSample& sample : samples) {
    if (time_ >= until) break;
    if (sample.stamp <= time_) continue;
    const Time next = std::min(sample.stamp, until);
    const Inertial end = inertial(sample);
    belief_ = predicted(belief_, input_, end, to_seconds(next - time_), config_.filter.noise);
    input_ = end;
    time_ = next;
  }
}

features::FeatureMatches RobocentricOdometry::match(const features::RingFeatures& scan,
                                                    const Pose& motion) const {
  return {line_matches(scan.sharp, motion, true, edges_, config_.matching),
          plane_matches(scan.flat, motion, true, planes_, config_.matching)};
}

Pose RobocentricOdometry::scan_match(const features::RingFeatures& scan,
                                     const Pose& initial) const {
  const auto associate = [&](const Pose& motion) {
    const features::FeatureMatches matches = match(scan, motion);
    const bool enough = static_cast<int>(matches.lines.size()) >= config_.scan_match.min_lines &&
                        static_cast<int>(matches.planes.size()) >= config_.scan_match.min_planes;
    return enough ? matches : features::FeatureMatches();
  };
  return features::solve_pose(initial, associate, config_.scan_match.solver).pose;
}

void RobocentricOdometry::set_reference(features::RingFeatures& scan, const Pose& motion) {
  move_to_scan_end(scan.less_sharp, motion);
  move_to_scan_end(scan.less_flat, motion);
  edges_.set(scan.less_sharp);
  planes_.set(scan.less_flat);
  last_time_ = time_;
}

/// The first two scans give position and velocity. As in the published program, the filter begins
/// at the position that the frame has already moved by.
OdometryResult RobocentricOdometry::start(features::RingFeatures& scan, const ImuSample& newest) {
  const bool enough =
      has(scan, config_.min_features.start_edges, config_.min_features.start_planes);
  if (phase_ == Phase::kNoScan) {
    if (!enough) return {};
    belief_ = Belief();
    set_reference(scan, Pose());
    phase_ = Phase::kOneScan;
    return {};
  }
  phase_ = Phase::kNoScan;
  const double duration = to_seconds(time_ - last_time_);
  const Pose motion = scan_match(scan, belief_.state.motion);
  if (!enough || duration <= 0.0 || !features::plausible_motion(motion)) return {};
  belief_ = {State(), start_covariance(config_.filter)};
  belief_.state.motion.translation = motion.translation;
  belief_.state.velocity = motion.translation / duration;
  T_world_lidar_ = T_world_lidar_ * motion;
  T_world_lidar_.rotation = levelled(T_world_lidar_.rotation, newest.specific_force);
  input_ = inertial(newest);
  set_reference(scan, motion);
  phase_ = Phase::kRunning;
  return {OdometryResult::Outcome::kStarted, {}};
}

OdometryResult RobocentricOdometry::correct(features::RingFeatures& scan) {
  using Outcome = OdometryResult::Outcome;
  if (!has(scan, config_.min_features.edges, config_.min_features.planes)) {
    return {Outcome::kUnchanged, {}};
  }
  features::FeatureMatches matches;
  const auto distances = [&](const State& x, int iteration) {
    const int interval = config_.update.association_interval;
    if (iteration % interval == 0) matches = match(scan, x.motion);
    const double slope = iteration < interval ? 0.0 : config_.update.weight_slope;
    return distances_at(x.motion, matches, {slope, config_.update.min_weight});
  };
  OdometryResult result;
  result.update = iterated_update(belief_, distances, config_.update);
  result.outcome = result.update.diverged ? Outcome::kRegistered : Outcome::kUpdated;
  belief_ = result.update.belief;
  if (result.update.diverged) belief_.state.motion = scan_match(scan, belief_.state.motion);
  const Pose motion = belief_.state.motion;
  const Pose moved = T_world_lidar_ * motion;
  if (!is_finite(belief_) || !features::plausible_motion(motion) ||
      moved.translation.norm() > kMaxDistance) {
    phase_ = Phase::kNoScan;
    result.outcome = Outcome::kRejected;
    return result;
  }
  belief_ = rebased(belief_, config_.filter.turn_gravity);
  T_world_lidar_ = {levelled(moved.rotation, belief_.state.gravity), moved.translation};
  set_reference(scan, motion);
  return result;
}

OdometryResult RobocentricOdometry::update(features::RingFeatures& scan,
                                           std::span<const ImuSample> samples,
                                           const ImuSample& newest, Time until) {
  if (phase_ == Phase::kNoScan) {
    time_ = until;
    input_ = inertial(newest);
  }
  predict(samples, until);
  return phase_ == Phase::kRunning ? correct(scan) : start(scan, newest);
}

}  // namespace aims::lins
