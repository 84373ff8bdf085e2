// SPDX-License-Identifier: BSD-3-Clause
#include "live/publications.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "estimator/estimator_spec.hpp"

namespace aims {
namespace {

// The errors of `MotionEstimate::covariance`, and those of the message.
constexpr int kRotation = 0;
constexpr int kPosition = 3;
constexpr int kVelocity = 6;
constexpr int kLinear = 0;   ///< position, linear velocity
constexpr int kAngular = 3;  ///< rotation, angular velocity

}  // namespace

OdometryContent odometry_between(const StampedPose& from, const StampedPose& to) {
  OdometryContent content;
  content.pose = to.pose;
  const double seconds = to_seconds(to.stamp - from.stamp);
  if (seconds <= 0.0) return content;
  const Pose moved = from.pose.inverse() * to.pose;
  content.angular_velocity = so3_log(moved.rotation) / seconds;
  content.linear_velocity = moved.rotation.inverse() * moved.translation / seconds;
  return content;
}

OdometryContent odometry_of(const MotionEstimate& motion) {
  const Eigen::Matrix3d R_odom_body = motion.T_odom_body.R();
  OdometryContent content;
  content.pose = motion.T_odom_body;
  content.linear_velocity = R_odom_body.transpose() * motion.velocity;
  content.angular_velocity = motion.angular_velocity;

  // R_hat Exp(d) = Exp(R_hat d) R_hat.
  Eigen::Matrix<double, 6, 9> of_pose = Eigen::Matrix<double, 6, 9>::Zero();
  of_pose.block<3, 3>(kLinear, kPosition).setIdentity();
  of_pose.block<3, 3>(kAngular, kRotation) = R_odom_body;
  content.pose_covariance = of_pose * motion.covariance * of_pose.transpose();

  // Exp(-d) R_hat^T (v + dv) = R_hat^T v + R_hat^T dv + (R_hat^T v) x d.
  Eigen::Matrix<double, 3, 9> of_velocity = Eigen::Matrix<double, 3, 9>::Zero();
  of_velocity.block<3, 3>(0, kVelocity) = R_odom_body.transpose();
  of_velocity.block<3, 3>(0, kRotation) = hat(content.linear_velocity);
  content.twist_covariance.block<3, 3>(kLinear, kLinear) =
      of_velocity * motion.covariance * of_velocity.transpose();
  content.twist_covariance.block<3, 3>(kAngular, kAngular) = motion.rate_covariance;
  return content;
}

Pose level(const Pose& pose) { return {yaw_rotation(yaw_of(pose.rotation)), pose.translation}; }

MotionEstimate placed_at(const Pose& T_frame_odom, const MotionEstimate& motion) {
  const Eigen::Matrix3d R = T_frame_odom.R();
  MotionEstimate placed = motion;
  placed.T_odom_body = T_frame_odom * motion.T_odom_body;
  placed.velocity = R * motion.velocity;
  Eigen::Matrix<double, 9, 9> turn = Eigen::Matrix<double, 9, 9>::Identity();
  turn.block<3, 3>(kPosition, kPosition) = R;
  turn.block<3, 3>(kVelocity, kVelocity) = R;
  placed.covariance = turn * motion.covariance * turn.transpose();
  return placed;
}

Publications::Publications(Transport& transport, const LiveOptions& options)
    : transport_(transport),
      serialization_(transport.format().serialization),
      options_(options),
      odometry_(transport.advertise("~odometry", odometry_type(), false)),
      fast_(transport.advertise("~odometry_fast", odometry_type(), false)),
      cloud_(transport.advertise("~cloud", point_cloud_type(), false)),
      map_(transport.advertise("~map", point_cloud_type(), false)),
      diagnostics_(transport.advertise("/diagnostics", diagnostics_type(), false)) {
  if (options_.tf) tf_ = transport.advertise("/tf", transforms_type(), false);
}

MessageHeader Publications::header(Time stamp) {
  return {.sequence = published_++, .stamp = stamp, .frame = options_.odom_frame};
}

void Publications::send(std::size_t publisher, const MessageBytes& message) {
  transport_.publish(publisher, message.view());
}

void Publications::pose(const StampedPose& pose, const std::optional<MotionEstimate>& motion) {
  OdometryContent content =
      motion ? odometry_of(*motion) : odometry_between(last_.value_or(pose), pose);
  content.pose = pose.pose;
  last_ = pose;
  send(odometry_,
       odometry_message(header(pose.stamp), options_.body_frame, content, serialization_));
  if (!options_.tf) return;
  const FrameTransform transform{options_.odom_frame, options_.body_frame, pose.pose};
  send(tf_, transforms_message(pose.stamp, {transform}, serialization_));
}

void Publications::fast(const MotionEstimate& motion) {
  send(fast_, odometry_message(header(motion.stamp), options_.body_frame, odometry_of(motion),
                               serialization_));
}

void Publications::cloud(Time stamp, std::span<const Eigen::Vector3f> points) {
  send(cloud_, points_message(header(stamp), points, serialization_));
}

void Publications::map(Time stamp, std::span<const Eigen::Vector3f> points) {
  send(map_, points_message(header(stamp), points, serialization_));
}

void Publications::health(const HealthRow& row,
                          std::vector<std::pair<std::string, std::string>> figures) {
  constexpr std::uint8_t kLevels[] = {1, 0, 1, 2};  // starting, healthy, degraded, invalid
  DiagnosticContent content;
  content.level = kLevels[static_cast<int>(row.state)];
  content.name = diagnostics_name(transport_.resolved("~odometry"));
  content.message = name_of(row.state);
  if (!row.reasons.empty()) {
    content.message += fmt::format(": {}", fmt::join(row.reasons, "; "));
  }
  if (std::isfinite(row.position_sigma)) {
    figures.insert(figures.begin(),
                   {"position sigma [m]", fmt::format("{:.3f}", row.position_sigma)});
  }
  figures.insert(figures.begin(), {"estimator", label_of(options_.estimator)});
  content.values = std::move(figures);
  send(diagnostics_, diagnostics_message(header(row.stamp), content, serialization_));
}

}  // namespace aims
