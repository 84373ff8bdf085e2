// SPDX-License-Identifier: BSD-3-Clause
#include "live/publications.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "live/odometry_content.hpp"

namespace aims {

Publications::Publications(Transport& transport, OdometryFrames frames, std::string estimator)
    : transport_(transport),
      serialization_(transport.format().serialization),
      frames_(std::move(frames)),
      estimator_(std::move(estimator)),
      odometry_(transport.advertise("~odometry", odometry_type(), false)),
      fast_(transport.advertise("~odometry_fast", odometry_type(), false)),
      cloud_(transport.advertise("~cloud", point_cloud_type(), false)),
      map_(transport.advertise("~map", point_cloud_type(), false)),
      diagnostics_(transport.advertise("/diagnostics", diagnostics_type(), false)) {
  if (frames_.tf) tf_ = transport.advertise("/tf", transforms_type(), false);
}

MessageHeader Publications::header(Time stamp) {
  return {.sequence = published_++, .stamp = stamp, .frame = frames_.odom};
}

void Publications::send(std::size_t publisher, const MessageBytes& message) {
  transport_.publish(publisher, message.view());
}

void Publications::pose(const StampedPose& pose, const std::optional<MotionEstimate>& motion) {
  OdometryContent content =
      motion ? odometry_of(*motion) : odometry_between(last_.value_or(pose), pose);
  content.pose = pose.pose;
  last_ = pose;
  send(odometry_, odometry_message(header(pose.stamp), frames_.body, content, serialization_));
  if (!frames_.tf) return;
  const FrameTransform transform{frames_.odom, frames_.body, pose.pose};
  send(tf_, transforms_message(pose.stamp, {transform}, serialization_));
}

void Publications::fast(const MotionEstimate& motion) {
  send(fast_,
       odometry_message(header(motion.stamp), frames_.body, odometry_of(motion), serialization_));
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
  figures.insert(figures.begin(), {"estimator", estimator_});
  content.values = std::move(figures);
  send(diagnostics_, diagnostics_message(header(row.stamp), content, serialization_));
}

}  // namespace aims
