// SPDX-License-Identifier: BSD-3-Clause
#include "ros/odometry_publisher.hpp"

#include <cstdint>
#include <utility>

#include "recordings/messages/message_types.hpp"

namespace aims {
namespace {

std::size_t advertise(RosTransport& transport, const char* topic, const MessageType& type) {
  return transport.advertise({.topic = topic,
                              .type = type.name,
                              .md5 = type.md5,
                              .definition = type.definition,
                              .latching = false});
}

void publish(RosTransport& transport, std::size_t publisher, const MessageBytes& message) {
  transport.publish(publisher, message.view().data(), message.view().size());
}

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

OdometryPublisher::OdometryPublisher(RosTransport& transport, OdometryFrames frames)
    : transport_(transport), frames_(std::move(frames)) {
  odometry_ = advertise(transport_, "~odometry", odometry_type());
  if (frames_.tf) tf_ = advertise(transport_, "/tf", transforms_type());
}

void OdometryPublisher::publish(const Trajectory& trajectory) {
  for (; published_ < trajectory.size(); ++published_) {
    const StampedPose& pose = trajectory[published_];
    const StampedPose& before = published_ > 0 ? trajectory[published_ - 1] : pose;
    const MessageHeader header{.sequence = static_cast<std::uint32_t>(published_),
                               .stamp = pose.stamp,
                               .frame = frames_.odom};
    const OdometryContent content = odometry_between(before, pose);
    aims::publish(transport_, odometry_, odometry_message(header, frames_.body, content));
    if (!frames_.tf) continue;
    const FrameTransform transform{frames_.odom, frames_.body, pose.pose};
    aims::publish(transport_, tf_, transforms_message(pose.stamp, {transform}));
  }
}

}  // namespace aims
