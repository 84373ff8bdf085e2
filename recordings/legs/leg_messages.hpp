// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/measurements.hpp"
#include "recordings/event_counts.hpp"
#include "recordings/legs/leg_names.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/messages/message_values.hpp"

namespace aims {

/// Angles and rates of the joints at an instant.
struct JointReading {
  Time stamp = 0;
  std::array<double, kJointCount> position{};               ///< [rad]
  std::optional<std::array<double, kJointCount>> velocity;  ///< [rad/s]
};

/// Which feet are in contact at an instant.
struct ContactReading {
  Time stamp = 0;
  std::array<bool, kLegCount> contact{};
};

/// The sample of a nav_msgs/Odometry, without contacts and joints.
std::optional<LegOdometrySample> odometry_at(const MessageView& message, EventCounts& counts);

/// The sample of a geometry_msgs/TwistStamped or Twist, without a pose.
std::optional<LegOdometrySample> twist_at(const MessageView& message, Time record_time);

/// The joints of a sensor_msgs/JointState; nothing when one is missing.
std::optional<JointReading> joints_at(const MessageView& message, Time record_time,
                                      const std::vector<std::string>& joint_names);

/// How contacts are read.
struct ContactRule {
  std::string field;
  double threshold = 20.0;  ///< smallest value of a foot in contact
  std::vector<std::string> foot_names;
};

/// The numbers of the contact field, one per foot in the order of the legs.
std::optional<std::array<double, kLegCount>> loads_at(const MessageView& message,
                                                      const ContactRule& rule);

std::optional<ContactReading> contacts_at(const MessageView& message, Time record_time,
                                          const ContactRule& rule);

}  // namespace aims
