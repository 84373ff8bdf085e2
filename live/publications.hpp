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
#include "live/transport.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"

namespace aims {

/// Frames of the published poses.
struct OdometryFrames {
  std::string odom;  ///< frame of the poses
  std::string body;  ///< child frame: the IMU's
  bool tf = false;   ///< also publish transforms on /tf
};

/// The topics of a live estimate: ~odometry with each pose, ~odometry_fast between them, ~cloud
/// (the registered points of a scan), ~map, /diagnostics, and /tf where it is asked for. What costs
/// time is made only for those who listen.
class Publications {
 public:
  Publications(Transport& transport, OdometryFrames frames, std::string estimator);

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
  OdometryFrames frames_;
  std::string estimator_;
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
