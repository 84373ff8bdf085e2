// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "recordings/messages/message_type.hpp"

namespace aims {

// States of Unitree's robots under ROS 2, which hold an IMU, joints or feet, and loads of the feet.
inline constexpr std::string_view kUnitreeLowState = "unitree_go/LowState";
inline constexpr std::string_view kUnitreeSportState = "unitree_go/SportModeState";

/// Loads of the feet in any unit, of messages that hold a foot each.
inline constexpr std::string_view kFootLoads = "aims_msgs/FootLoads";

/// Where the feet are in the base, of messages that hold a foot each: FL, FR, RL, RR.
inline constexpr std::string_view kFootPlaces = "aims_msgs/FootPlaces";

/// Loads of the feet in any unit, of a table of comma-separated values.
inline constexpr std::string_view kFootForces = "aims_msgs/FootForces";

// The message types that AIMS writes, as ROS 1 has them. Definitions hold the fields without
// comments, which do not enter the md5.
MessageType string_type();         ///< std_msgs/String
MessageType point_cloud_type();    ///< sensor_msgs/PointCloud2
MessageType imu_type();            ///< sensor_msgs/Imu
MessageType joint_state_type();    ///< sensor_msgs/JointState
MessageType odometry_type();       ///< nav_msgs/Odometry
MessageType transforms_type();     ///< tf2_msgs/TFMessage
MessageType diagnostics_type();    ///< diagnostic_msgs/DiagnosticArray
MessageType foot_forces_type();    ///< aims_msgs/FootForces: loads in any unit
MessageType foot_loads_type();     ///< aims_msgs/FootLoads: likewise, of single feet
MessageType foot_places_type();    ///< aims_msgs/FootPlaces: where the feet are in the base
MessageType foot_contacts_type();  ///< aims_msgs/FootContacts: contacts and forces of the feet

/// A usual type as ROS 2 has it, or nothing: what AIMS writes or reads, also of Livox and Unitree.
std::optional<MessageType> known_ros2_type(std::string_view name);

/// Fills in the definition of a usual type in ROS 2 where a recording has none, as before ROS 2
/// Iron.
void complete_definition(std::string_view type, std::string& definition, MessageFormat& format);

}  // namespace aims
