// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/message_encoding.hpp"

#include <array>
#include <cstring>

#include "core/leg_kinematics.hpp"

namespace aims {
namespace {

/// First entry of a covariance whose quantity is not estimated (sensor_msgs/Imu).
constexpr double kNoEstimate = -1.0;
constexpr std::size_t kPointStep = 22;
constexpr std::uint8_t kPointUint16 = 4;
constexpr std::uint8_t kPointFloat32 = 7;
constexpr std::array<std::string_view, 3> kJointsOfLeg = {"hip_joint", "thigh_joint", "calf_joint"};

void put(MessageBytes& out, const MessageHeader& header) {
  if (!out.is_cdr()) out.put(header.sequence);
  out.time(header.stamp);
  out.text(header.frame);
}

void put(MessageBytes& out, const Eigen::Vector3d& v) {
  for (int i = 0; i < 3; ++i) out.put(v[i]);
}

void put(MessageBytes& out, const Eigen::Quaterniond& q) {
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) out.put(value);
}

void put_unknown_covariance(MessageBytes& out, int size) {
  for (int i = 0; i < size * size; ++i) out.put(0.0);
}

void put_point_field(MessageBytes& out, std::string_view name, std::uint32_t offset,
                     std::uint8_t type) {
  out.text(name);
  out.put(offset);
  out.put(type);
  out.put(std::uint32_t{1});
}

void write_point(const LidarPoint& point, std::byte* bytes) {
  const auto time = static_cast<float>(point.time_offset_ns * 1e-9);
  std::memcpy(bytes, point.position.data(), 12);
  std::memcpy(bytes + 12, &point.intensity, 4);
  std::memcpy(bytes + 16, &point.ring, 2);
  std::memcpy(bytes + 18, &time, 4);
}

}  // namespace

MessageBytes cloud_message(const MessageHeader& header, const LidarScan& scan,
                           Serialization serialization) {
  MessageBytes out(serialization);
  const auto width = static_cast<std::uint32_t>(scan.points.size());
  out.reserve(256 + kPointStep * scan.points.size());
  put(out, header);
  out.put(std::uint32_t{1});  // height
  out.put(width);
  out.length(6);
  put_point_field(out, "x", 0, kPointFloat32);
  put_point_field(out, "y", 4, kPointFloat32);
  put_point_field(out, "z", 8, kPointFloat32);
  put_point_field(out, "intensity", 12, kPointFloat32);
  put_point_field(out, "ring", 16, kPointUint16);
  put_point_field(out, "time", 18, kPointFloat32);
  out.put(false);  // is_bigendian
  out.put(static_cast<std::uint32_t>(kPointStep));
  out.put(static_cast<std::uint32_t>(kPointStep * width));
  out.length(kPointStep * scan.points.size());
  std::byte* next = out.extend(kPointStep * scan.points.size());
  for (const LidarPoint& point : scan.points) {
    write_point(point, next);
    next += kPointStep;
  }
  out.put(true);  // is_dense
  return out;
}

MessageBytes imu_message(const MessageHeader& header, const ImuSample& sample,
                         Serialization serialization) {
  MessageBytes out(serialization);
  put(out, header);
  put(out, sample.orientation.value_or(Eigen::Quaterniond::Identity()));
  out.put(sample.orientation ? 0.0 : kNoEstimate);
  for (int i = 1; i < 9; ++i) out.put(0.0);
  put(out, sample.angular_velocity);
  put_unknown_covariance(out, 3);
  put(out, sample.specific_force);
  put_unknown_covariance(out, 3);
  return out;
}

MessageBytes odometry_message(const MessageHeader& header, std::string_view child_frame,
                              const OdometryContent& content, Serialization serialization) {
  MessageBytes out(serialization);
  put(out, header);
  out.text(child_frame);
  put(out, content.pose.translation);
  put(out, content.pose.rotation);
  put_unknown_covariance(out, 6);
  put(out, content.linear_velocity);
  put(out, content.angular_velocity);
  put_unknown_covariance(out, 6);
  return out;
}

MessageBytes joint_state_message(const MessageHeader& header, const LegOdometrySample& sample,
                                 Serialization serialization) {
  MessageBytes out(serialization);
  put(out, header);
  out.length(kJointCount);
  for (const std::string_view leg : kLegNames) {
    for (const std::string_view joint : kJointsOfLeg) {
      out.text(std::string(leg) + "_" + std::string(joint));
    }
  }
  out.array(sample.joint_position);
  out.array(sample.joint_velocity);
  out.length(0);  // no effort
  return out;
}

MessageBytes foot_contacts_message(const MessageHeader& header, const LegOdometrySample& sample,
                                   Serialization serialization) {
  MessageBytes out(serialization);
  put(out, header);
  out.length(kLegNames.size());
  for (const std::string_view foot : kLegNames) out.text(foot);
  out.length(sample.contact.size());
  for (const bool in_contact : sample.contact) out.put(in_contact);
  return out;
}

MessageBytes transforms_message(Time stamp, const std::vector<FrameTransform>& transforms,
                                Serialization serialization) {
  MessageBytes out(serialization);
  out.length(transforms.size());
  for (const FrameTransform& each : transforms) {
    put(out, MessageHeader{0, stamp, each.parent});
    out.text(each.child);
    put(out, each.T_parent_child.translation);
    put(out, each.T_parent_child.rotation);
  }
  return out;
}

MessageBytes string_message(std::string_view text, Serialization serialization) {
  MessageBytes out(serialization);
  out.text(text);
  return out;
}

}  // namespace aims
