// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/message_encoding.hpp"

#include <array>

#include "core/leg_kinematics.hpp"

namespace aims {
namespace {

/// First entry of a covariance whose quantity is not estimated (sensor_msgs/Imu).
constexpr double kNoEstimate = -1.0;
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

/// Row by row.
void put(MessageBytes& out, const Eigen::Matrix<double, 6, 6>& covariance) {
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) out.put(covariance(row, column));
  }
}

void put_unknown_covariance(MessageBytes& out, int size) {
  for (int i = 0; i < size * size; ++i) out.put(0.0);
}

}  // namespace

MessageBytes cloud_message(const MessageHeader& header, const LidarScan& scan,
                           Serialization serialization, const CloudFormat& format) {
  const PointLayout layout = point_layout(format.layout);
  const PointBlock points = point_block(scan, format);
  MessageBytes out(serialization);
  out.reserve(512 + points.bytes.size());
  put(out, header);
  out.put(points.height);
  out.put(points.width);
  out.length(layout.fields.size());
  for (const PointFieldLayout& field : layout.fields) {
    out.text(field.name);
    out.put(field.offset);
    out.put(field.type);
    out.put(std::uint32_t{1});  // count
  }
  out.put(false);  // is_bigendian
  out.put(layout.point_step);
  out.put(layout.point_step * points.width);
  out.array(points.bytes);
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
  put(out, content.pose_covariance);
  put(out, content.linear_velocity);
  put(out, content.angular_velocity);
  put(out, content.twist_covariance);
  return out;
}

MessageBytes diagnostics_message(const MessageHeader& header, const DiagnosticContent& content,
                                 Serialization serialization) {
  MessageBytes out(serialization);
  put(out, header);
  out.length(1);
  out.put(content.level);
  out.text(content.name);
  out.text(content.message);
  out.text("");  // no hardware
  out.length(content.values.size());
  for (const auto& [key, value] : content.values) {
    out.text(key);
    out.text(value);
  }
  return out;
}

MessageBytes points_message(const MessageHeader& header, std::span<const Eigen::Vector3f> points,
                            Serialization serialization) {
  constexpr std::uint8_t kFloat32 = 7;  // of sensor_msgs/PointField
  constexpr std::uint32_t kStep = 12;   // of a point [bytes]
  static_assert(sizeof(Eigen::Vector3f) == kStep);
  const auto count = static_cast<std::uint32_t>(points.size());
  MessageBytes out(serialization);
  out.reserve(512 + points.size_bytes());
  put(out, header);
  out.put(std::uint32_t{1});  // height
  out.put(count);
  out.length(3);
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    out.text(std::string_view("xyz").substr(axis, 1));
    out.put(axis * std::uint32_t{sizeof(float)});
    out.put(kFloat32);
    out.put(std::uint32_t{1});
  }
  out.put(false);  // is_bigendian
  out.put(kStep);
  out.put(kStep * count);
  out.length(points.size_bytes());
  out.append(points.data(), points.size_bytes());
  out.put(true);  // is_dense
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
  const FootLoads none{};
  const std::size_t forces = sample.contact_force ? none.size() : 0;
  out.array(std::span(sample.contact_force ? *sample.contact_force : none).first(forces));
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
