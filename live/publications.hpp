// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/trajectory.hpp"
#include "estimator/interface/health.hpp"
#include "estimator/interface/motion.hpp"
#include "live/live_config.hpp"
#include "live/transport.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"

namespace aims {

/// The pose `to` with the mean twist since `from`, in the axes of `to`; covariances unknown.
OdometryContent odometry_between(const StampedPose& from, const StampedPose& to);

/// The motion in the frames that nav_msgs/Odometry defines: the covariance of the pose about the
/// fixed axes of the odometry frame, twist and its covariance in the axes of the body.
OdometryContent odometry_of(const MotionEstimate& motion);

/// The pose with its heading and position alone.
Pose level(const Pose& pose);

/// The motion in the frame in which its odometry frame has the level pose `T_frame_odom`.
MotionEstimate placed_at(const Pose& T_frame_odom, const MotionEstimate& motion);

/// The topics of a live estimate: ~odometry with each pose, ~odometry_fast between them, ~cloud
/// (the registered points of a scan), ~map, /diagnostics, and /tf where it is asked for. What costs
/// time is made only for those who listen.
class Publications {
 public:
  Publications(Transport& transport, const LiveOptions& options);

  /// A pose of the trajectory; `motion`: the estimate at about that instant, whose twist and
  /// covariances are published, none: the mean twist since the last pose.
  void pose(const StampedPose& pose, const std::optional<MotionEstimate>& motion);

  /// Whether somebody listens.
  bool fast_heard() const { return transport_.heard(fast_); }
  bool cloud_heard() const { return transport_.heard(cloud_); }
  bool map_heard() const { return transport_.heard(map_); }

  void fast(const MotionEstimate& motion);
  void cloud(Time stamp, std::span<const Eigen::Vector3f> points);
  void map(Time stamp, std::span<const Eigen::Vector3f> points);

  /// The state, with figures of the node: their names and values.
  void health(const HealthRow& row, std::vector<std::pair<std::string, std::string>> figures);

 private:
  MessageHeader header(Time stamp);
  void send(std::size_t publisher, const MessageBytes& message);

  Transport& transport_;
  Serialization serialization_;
  const LiveOptions& options_;
  std::size_t odometry_ = 0;
  std::size_t fast_ = 0;
  std::size_t cloud_ = 0;
  std::size_t map_ = 0;
  std::size_t diagnostics_ = 0;
  std::size_t tf_ = 0;
  std::uint32_t published_ = 0;
  std::optional<StampedPose> last_;
};

}  // namespace aims
