// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "recordings/messages/message_type.hpp"

namespace aims {

// The message types that AIMS writes. Definitions hold the fields without comments, which do not
// enter the md5.
MessageType string_type();         ///< std_msgs/String
MessageType point_cloud_type();    ///< sensor_msgs/PointCloud2
MessageType imu_type();            ///< sensor_msgs/Imu
MessageType joint_state_type();    ///< sensor_msgs/JointState
MessageType odometry_type();       ///< nav_msgs/Odometry
MessageType transforms_type();     ///< tf2_msgs/TFMessage
MessageType foot_contacts_type();  ///< aims_msgs/FootContacts: which feet are in contact

}  // namespace aims
