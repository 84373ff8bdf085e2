// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/measurements.hpp"
#include "recordings/messages/message_bytes.hpp"
#include "recordings/messages/message_values.hpp"
#include "recordings/messages/point_layout.hpp"

namespace aims {

/// std_msgs/Header.
struct MessageHeader {
  std::uint32_t sequence = 0;  ///< ROS 1 alone
  Time stamp = 0;              ///< >= 0
  std::string_view frame;
};

/// Pose and twist of nav_msgs/Odometry.
struct OdometryContent {
  Pose pose;                                                  ///< child frame in the header's frame
  Eigen::Vector3d linear_velocity = Eigen::Vector3d::Zero();  ///< in child axes [m/s]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< in child axes [rad/s]
  /// Of position, then rotation about the fixed axes of the header's frame; zero: unknown.
  Eigen::Matrix<double, 6, 6> pose_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// Of linear, then angular velocity, in child axes; zero: unknown.
  Eigen::Matrix<double, 6, 6> twist_covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// One diagnostic_msgs/DiagnosticStatus.
struct DiagnosticContent {
  std::uint8_t level = 0;  ///< 0 ok, 1 warning, 2 error, 3 stale
  std::string name;
  std::string message;
  std::vector<std::pair<std::string, std::string>> values;
};

// Messages in either serialization.

/// sensor_msgs/PointCloud2 in the layout of `format`, see `point_block`. By default 22 bytes a
/// point: x, y, z, intensity float32 at 0, 4, 8, 12, ring uint16 at 16, time float32 [s] after the
/// header's stamp at 18; in firing order, height 1.
MessageBytes cloud_message(const MessageHeader& header, const LidarScan& scan,
                           Serialization serialization = Serialization::kRos1,
                           const CloudFormat& format = {});

/// sensor_msgs/Imu; covariances unknown (zero). Without an orientation the first entry of its
/// covariance is -1 and the quaternion the identity.
MessageBytes imu_message(const MessageHeader& header, const ImuSample& sample,
                         Serialization serialization = Serialization::kRos1);

/// nav_msgs/Odometry.
MessageBytes odometry_message(const MessageHeader& header, std::string_view child_frame,
                              const OdometryContent& content,
                              Serialization serialization = Serialization::kRos1);

/// sensor_msgs/JointState of the twelve joints, leg by leg; no effort.
MessageBytes joint_state_message(const MessageHeader& header, const LegOdometrySample& sample,
                                 Serialization serialization = Serialization::kRos1);

/// aims_msgs/FootContacts; without forces where the sample has none.
MessageBytes foot_contacts_message(const MessageHeader& header, const LegOdometrySample& sample,
                                   Serialization serialization = Serialization::kRos1);

/// tf2_msgs/TFMessage of fixed transforms, stamped `stamp`.
MessageBytes transforms_message(Time stamp, const std::vector<FrameTransform>& transforms,
                                Serialization serialization = Serialization::kRos1);

/// diagnostic_msgs/DiagnosticArray of one status.
MessageBytes diagnostics_message(const MessageHeader& header, const DiagnosticContent& content,
                                 Serialization serialization = Serialization::kRos1);

/// sensor_msgs/PointCloud2 of bare points, x, y, z float32 [m].
MessageBytes points_message(const MessageHeader& header, std::span<const Eigen::Vector3f> points,
                            Serialization serialization = Serialization::kRos1);

/// std_msgs/String.
MessageBytes string_message(std::string_view text,
                            Serialization serialization = Serialization::kRos1);

}  // namespace aims
