// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <string_view>
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

/// nav_msgs/Odometry; covariances unknown (zero).
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

/// std_msgs/String.
MessageBytes string_message(std::string_view text,
                            Serialization serialization = Serialization::kRos1);

}  // namespace aims
