// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "core/trajectory.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "ros/transport.hpp"

namespace aims {

/// Frames of the published poses.
struct OdometryFrames {
  std::string odom;  ///< frame of the poses
  std::string body;  ///< child frame: the IMU's
  bool tf = false;   ///< also publish transforms on /tf
};

/// The pose `to` with the mean twist since `from`, in the axes of `to`.
OdometryContent odometry_between(const StampedPose& from, const StampedPose& to);

/// Publishes an estimator's poses as nav_msgs/Odometry on ~odometry, and optionally on /tf.
class OdometryPublisher {
 public:
  OdometryPublisher(RosTransport& transport, OdometryFrames frames);

  /// Publishes the poses that are new since the last call.
  void publish(const Trajectory& trajectory);

  std::size_t published() const { return published_; }

 private:
  RosTransport& transport_;
  OdometryFrames frames_;
  std::size_t odometry_ = 0;
  std::size_t tf_ = 0;
  std::size_t published_ = 0;
};

}  // namespace aims
