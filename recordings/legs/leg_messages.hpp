// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/measurements.hpp"
#include "recordings/event_counts.hpp"
#include "recordings/legs/contact_detector.hpp"
#include "recordings/legs/leg_names.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/messages/message_values.hpp"
#include "recordings/messages/robot_states.hpp"

namespace aims {

/// Angles and rates of the joints at an instant.
struct JointReading {
  Time stamp = 0;
  std::array<double, kJointCount> position{};               ///< [rad]
  std::optional<std::array<double, kJointCount>> velocity;  ///< [rad/s]
  bool differenced = false;               ///< the rates are differences to the angles before
  std::array<bool, kLegCount> unknown{};  ///< the leg has an angle that is no number
};

/// Which feet are in contact at an instant.
struct ContactReading {
  Time stamp = 0;
  std::array<bool, kLegCount> contact{};
  std::optional<FootLoads> force = std::nullopt;  ///< if the message has them in newtons
};

/// The sample of a nav_msgs/Odometry, without contacts and joints.
std::optional<LegOdometrySample> odometry_at(const MessageView& message, EventCounts& counts);

/// The sample of a geometry_msgs/TwistStamped or Twist, without a pose.
std::optional<LegOdometrySample> twist_at(const MessageView& message, Time record_time);

/// How contacts are read.
struct ContactRule {
  std::string field;  ///< path, also of a field of each entry: "contacts[].state"
  std::array<ContactThreshold, kLegCount> thresholds;
  std::vector<std::string> foot_names;
  const StateLayout* state = nullptr;  ///< of the message's type, if `field` is its contacts
  const StateLayout* knees = nullptr;  ///< likewise, if `field` has a number for each of its joints
  FootLoads force_signs = {1.0, 1.0, 1.0, 1.0};  ///< -1: of a foot whose forces are reversed
};

/// How joints are read.
struct JointRule {
  std::vector<std::string> names;      ///< as configured; empty: by the recorded names
  std::optional<JointOrder> order;     ///< where the recorded names do not tell
  const StateLayout* state = nullptr;  ///< of the message's type; null: a sensor_msgs/JointState
  double scale = 1.0;                  ///< of the angles and rates to rad and rad/s
};

/// The joints of a sensor_msgs/JointState or a robot's state; nothing when one is missing.
std::optional<JointReading> joints_at(const MessageView& message, Time record_time,
                                      const JointRule& rule);

/// Twelve angles whose names tell no joint, with their rates as far as recorded, and the names.
struct UnnamedJoints {
  std::vector<double> angles, rates;
  std::vector<std::string> names;
};
std::optional<UnnamedJoints> unnamed_joints_at(const MessageView& message, const JointRule& rule);

/// The names of the joints; none where the message has none.
std::vector<std::string_view> joint_names_at(const MessageView& message, const StateLayout* state);

/// Whether the names tell which foot each number of the contacts belongs to.
bool feet_are_named(const MessageView& message, const ContactRule& rule);

/// The feet at an instant, without the joints above them.
struct FeetReading {
  Time stamp = 0;
  std::array<Eigen::Vector3d, kLegCount> position;  ///< in the base [m]
  std::array<Eigen::Vector3d, kLegCount> velocity;  ///< relative to the base, in its axes [m/s]
  bool has_velocity = true;                         ///< false: differences of the places serve
};

/// The numbers of the contact field, one per foot in the order of the legs.
std::optional<FootLoads> loads_at(const MessageView& message, const ContactRule& rule);

/// The forces in an aims_msgs/FootContacts; none in those of earlier versions.
std::optional<FootLoads> forces_at(const MessageView& message, const ContactRule& rule);

/// The feet of a robot's state. A foot of a biped is both legs of its side.
std::optional<FeetReading> feet_at(const MessageView& message, Time record_time,
                                   const StateLayout& state);

}  // namespace aims
