// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/leg_dead_reckoning.hpp"

#include <algorithm>

namespace aims {
namespace {

/// The transform that removes position and heading of `T_odom_body`; roll and pitch stay relative
/// to gravity.
Pose start_transform(const Pose& T_odom_body) {
  return Pose{yaw_rotation(yaw_of(T_odom_body.rotation)), T_odom_body.translation}.inverse();
}

}  // namespace

void describe(Fields& f, LegDeadReckoningConfig& c) {
  f.number("max_speed", c.max_speed, {"m/s", positive_up_to(1e3), "faster samples are rejected"});
  f.group("queue", c.queue);
}

Requirements requirements_of(const LegDeadReckoningConfig&) { return {.legs = true}; }

LegDeadReckoning::LegDeadReckoning(const LegDeadReckoningConfig& config, const SensorRig& rig)
    : QueuedEstimator(config.queue, rig, {}, config.max_speed),
      health_({.legs = true}, ImuPropagationConfig().gravity) {}

void LegDeadReckoning::finish() {
  QueuedEstimator::finish();
  for (Time stamp : waiting_) {
    if (last_) result_.trajectory.push_back({stamp, last_->pose});
  }
  waiting_.clear();
  if (queue_.now()) close_health(result_.health, judged_health(*queue_.now()));
}

void LegDeadReckoning::judge_health() {
  const std::optional<Time> now = queue_.now();
  if (!now || (judged_ && *now - *judged_ < HealthMonitor::kInterval)) return;
  append_health(result_.health, judged_health(*now));
}

HealthRow LegDeadReckoning::judged_health(Time now) {
  judged_ = now;
  std::optional<HealthEstimate> estimate;
  if (last_) estimate = {last_->pose.translation, speed_, kNotComputed};
  speed_ = 0.0;
  return health_.judge(now, queue_.inputs(), estimate);
}

void LegDeadReckoning::process_legs(const LegOdometrySample& sample) {
  const Pose T_odom_body = sample.T_odom_base * rig_.T_body_base.inverse();
  if (!T_start_odom_) T_start_odom_ = start_transform(T_odom_body);
  const StampedPose now{sample.stamp, *T_start_odom_ * T_odom_body};
  for (Time stamp : waiting_) {
    const Pose pose =
        last_ ? interpolate(last_->pose, now.pose,
                            to_seconds(stamp - last_->stamp) / to_seconds(now.stamp - last_->stamp))
              : now.pose;
    result_.trajectory.push_back({stamp, pose});
  }
  waiting_.clear();
  if (!start_) start_ = now.stamp;
  const Time last_pose = result_.trajectory.empty() ? *start_ : result_.trajectory.back().stamp;
  if (now.stamp - last_pose >= kMaxPoseInterval) result_.trajectory.push_back(now);
  if (last_ && now.stamp > last_->stamp) {
    const double step = (now.pose.translation - last_->pose.translation).norm();
    speed_ = std::max(speed_, step / to_seconds(now.stamp - last_->stamp));
  }
  last_ = now;
  queue_.imu().forget_before(sample.stamp);
}

void LegDeadReckoning::process_scan(const LidarScanPtr& scan) { waiting_.push_back(scan->end); }

}  // namespace aims
