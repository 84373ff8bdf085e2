// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/leg_kinematics.hpp"
#include "core/measurements.hpp"
#include "recordings/messages/message_bytes.hpp"
#include "recordings/messages/message_type.hpp"

namespace aims::test {

/// What a robot measures at an instant.
struct RobotSample {
  Time stamp = 0;
  int number = 0;                            ///< of the sample
  double turn_rate = 0.0;                    ///< about z [rad/s]
  JointVector angles = JointVector::Zero();  ///< FL, FR, RL, RR [rad]
  JointVector rates = JointVector::Zero();   ///< [rad/s]
  std::array<bool, kLegCount> contact{};
  bool has_foot_sensors = true;
  std::array<float, 4> quaternion = {1.0F, 0.0F, 0.0F, 0.0F};  ///< as the message has it
  std::array<Eigen::Vector3d, kLegCount> feet{};         ///< in the base [m]
  std::array<Eigen::Vector3d, kLegCount> foot_speeds{};  ///< in the base [m/s]
};

/// A message type as its package publishes the definition, and a sample as its message.
struct RobotMessage {
  std::string name;  ///< of the test
  MessageType type;
  std::function<MessageBytes(const RobotSample&)> encode;
};

// unitree_legged_msgs: of unitree_ros_to_real 3.8 (Go1), with the stamp of the Leg-KILO data, with
// a header as in FusionPortable, and of the version before (A1, Aliengo), which has no joints.
RobotMessage go1_high_state();
RobotMessage leg_kilo_high_state();
RobotMessage fusion_portable_high_state();
RobotMessage feet_high_state();
RobotMessage go1_low_state();
RobotMessage a1_low_state();

/// anymal_msgs/AnymalState with these names of joints and feet; `package` is that of the joints.
RobotMessage anymal_state(const std::vector<std::string>& joints,
                          const std::vector<std::string>& feet,
                          const std::string& package = "any_msgs");
std::vector<std::string> anymal_joints();
std::vector<std::string> anymal_feet();
/// series_elastic_actuator_msgs/SeActuatorReadings; the knees of feet in contact bear.
RobotMessage actuator_readings();
/// spot_msgs/FootStateArray of the ROS 1 driver.
RobotMessage spot_feet();
/// unitree_hg/LowState; joints 0 to 5 are the left leg, 6 to 11 the right one.
RobotMessage humanoid_state();

}  // namespace aims::test
