// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/message_values.hpp"

#include <cmath>
#include <string>

namespace aims {
namespace {

using NoMessages = std::vector<MessageView>;

/// A rotation, normalized unless it is no rotation at all, which is counted.
std::optional<Eigen::Quaterniond> valid_orientation(Eigen::Quaterniond rotation,
                                                    EventCounts& counts) {
  const double norm = rotation.norm();
  if (!(norm > 0.5) || !(norm < 2.0)) {
    ++counts["imu_orientation_invalid"];
    return std::nullopt;
  }
  if (is_off_unit(rotation)) rotation.normalize();
  return rotation;
}

}  // namespace

Time header_stamp(const MessageView& message, Time record_time) {
  if (const auto stamp = message.time("header.stamp")) return *stamp;
  const auto seconds = message.number("stamp.sec");
  const auto rest = message.number("stamp.nanosec");
  if (!seconds || !rest) return record_time;
  return static_cast<Time>(*seconds) * kSecond + static_cast<Time>(*rest);
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
  return valid_orientation(*rotation, counts);
}

std::optional<ImuSample> imu_at(const MessageView& message, Time record_time, EventCounts& counts) {
  ImuSample sample;
  sample.stamp = header_stamp(message, record_time);
  const auto turn = vector_at(message, "angular_velocity");
  const auto force = vector_at(message, "linear_acceleration");
  if (turn && force) {
    sample.angular_velocity = *turn;
    sample.specific_force = *force;
    sample.orientation = imu_orientation(message, counts);
    return sample;
  }
  const auto gyroscope = message.numbers("imu_state.gyroscope");
  const auto accelerometer = message.numbers("imu_state.accelerometer");
  const auto rotation = message.numbers("imu_state.quaternion");
  if (!gyroscope || !accelerometer || !rotation) return std::nullopt;
  if (gyroscope->size() != 3 || accelerometer->size() != 3 || rotation->size() != 4) {
    return std::nullopt;
  }
  sample.angular_velocity = Eigen::Vector3d(gyroscope->data());
  sample.specific_force = Eigen::Vector3d(accelerometer->data());
  const std::vector<double>& q = *rotation;
  sample.orientation = valid_orientation(Eigen::Quaterniond(q[0], q[1], q[2], q[3]), counts);
  return sample;
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
