// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/message_values.hpp"

#include <cmath>
#include <string>

namespace aims {
namespace {

using NoMessages = std::vector<MessageView>;

}  // namespace

Time header_stamp(const MessageView& message, Time record_time) {
  return message.time("header.stamp").value_or(record_time);
}

std::optional<Eigen::Vector3d> vector_at(const MessageView& message, std::string_view path) {
  const std::string prefix = std::string(path) + '.';
  const auto x = message.number(prefix + "x");
  const auto y = message.number(prefix + "y");
  const auto z = message.number(prefix + "z");
  if (!x || !y || !z) return std::nullopt;
  return Eigen::Vector3d(*x, *y, *z);
}

std::optional<Eigen::Quaterniond> quaternion_at(const MessageView& message, std::string_view path) {
  const auto axis = vector_at(message, path);
  const auto w = message.number(std::string(path) + ".w");
  if (!axis || !w) return std::nullopt;
  return Eigen::Quaterniond(*w, axis->x(), axis->y(), axis->z());
}

std::vector<FrameTransform> transforms_in(const MessageView& message) {
  constexpr std::size_t kMaxTransforms = 1000;
  std::vector<FrameTransform> transforms;
  for (const MessageView& each : message.messages("transforms").value_or(NoMessages())) {
    const auto parent = each.text("header.frame_id");
    const auto child = each.text("child_frame_id");
    const auto translation = vector_at(each, "transform.translation");
    const auto rotation = quaternion_at(each, "transform.rotation");
    if (!parent || !child || !translation || !rotation) break;
    if (transforms.size() == kMaxTransforms) break;
    transforms.push_back({*parent, *child, {*rotation, *translation}});
  }
  return transforms;
}

bool is_off_unit(const Eigen::Quaterniond& rotation) {
  return !(std::abs(rotation.norm() - 1.0) <= 1e-9);
}

std::optional<Eigen::Quaterniond> imu_orientation(const MessageView& message, EventCounts& counts) {
  auto rotation = quaternion_at(message, "orientation");
  const auto covariance = message.numbers("orientation_covariance");
  const bool estimated = !covariance || covariance->empty() || covariance->front() != -1.0;
  if (!rotation || !estimated) return std::nullopt;
  const double norm = rotation->norm();
  if (!(norm > 0.5) || !(norm < 2.0)) {
    ++counts["imu_orientation_invalid"];
    return std::nullopt;
  }
  if (is_off_unit(*rotation)) rotation->normalize();
  return rotation;
}

std::optional<Pose> message_pose(const MessageView& message, std::string_view path,
                                 EventCounts& counts) {
  const std::string prefix(path);
  const auto position = vector_at(message, prefix + ".position");
  const auto rotation = quaternion_at(message, prefix + ".orientation");
  if (!position || !rotation) return std::nullopt;
  Pose pose{*rotation, *position};
  const double norm = pose.rotation.norm();
  if (!(norm > 0.5) || !(norm < 2.0)) {
    ++counts["pose_without_rotation"];
    pose.rotation.setIdentity();
  } else if (is_off_unit(pose.rotation)) {
    pose.rotation.normalize();
  }
  return pose;
}

}  // namespace aims
