// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/robot_states.hpp"

#include <algorithm>
#include <initializer_list>
#include <vector>

#include "recordings/messages/message_types.hpp"
#include "recordings/messages/words.hpp"

namespace aims {
namespace {

// Unitree lists its legs FR, FL, RR, RL (unitree_legged_sdk, unitree_sdk2).
constexpr std::array<int, kLegCount> kUnitree = {1, 0, 3, 2};

// Unitree Go2: go2_description of unitree_ros.
constexpr LegGeometry kGo2 = {0.1934, 0.0465, 0.0955, 0.213, 0.213, 0.022};

// ANYmal C: anymal_c_simple_description. The hip joint lies (0.2999, 0.104) m from the centre, the
// thigh's (0.0599, 0.08381) m from it, the knee (0.1003, -0.285) m (y, z) from that, and the foot
// (0.08795, 0.01305, -0.33797) m from the knee: forward in front, backward behind.
constexpr LegGeometry kAnymalC = {0.3598, 0.104, 0.19716, 0.285, 0.349226, 0.03};
constexpr double kAnymalKnee = -0.25458367;  ///< -atan(0.08795 / 0.33797)

// G1 with 29 joints: g1_29dof of unitree_ros. Hip pitch, roll, yaw, knee, ankle pitch, roll.
constexpr BipedLegs kG1 = {{{{{0.0, 0.064452, -0.1027}, 0.0, 1},
                             {{0.0, 0.052, -0.030465}, -0.1749, 0},
                             {{0.025001, 0.0, -0.12412}, 0.0, 2},
                             {{-0.078273, 0.0021489, -0.17734}, 0.1749, 1},
                             {{0.0, -9.4445e-05, -0.30001}, 0.0, 1},
                             {{0.0, 0.0, -0.017558}, 0.0, 0}}},
                           0.035,
                           3};

/// Messages of Unitree in ROS 1 exist with fields like footForce and like foot_force.
enum class Spelling { kCamelCase, kSnakeCase };

constexpr StateLayout motors_of_unitree(std::string_view type, std::string_view topic,
                                        std::string_view imu, Spelling spelling,
                                        std::string_view robot = {},
                                        const LegGeometry* geometry = nullptr) {
  const bool camel = spelling == Spelling::kCamelCase;
  return {.type = type,
          .robot = robot,
          .topic = topic,
          .imu = imu,
          .angles = camel ? "motorState[].q" : "motor_state[].q",
          .rates = camel ? "motorState[].dq" : "motor_state[].dq",
          .contacts = camel ? "footForce" : "foot_force",
          .legs = kUnitree,
          .geometry = geometry};
}

constexpr StateLayout actuators_of_anymal(std::string_view type) {
  return {.type = type,
          .robot = "an ANYmal C",
          .topic = "/actuator_readings",
          .angles = "readings[].state.joint_position",
          .rates = "readings[].state.joint_velocity",
          .joint_names = "readings[].state.name",
          .contacts = "readings[].state.joint_torque",
          .foot_names = "readings[].state.name",
          .contact_kind = ContactKind::kTorque,
          .knee_offset = kAnymalKnee,
          .geometry = &kAnymalC};
}

constexpr auto kStates = std::to_array<StateLayout>({
    motors_of_unitree("unitree_go/LowState", "/lowstate", "imu_state", Spelling::kSnakeCase,
                      "a Go2", &kGo2),
    {.type = "unitree_go/SportModeState",
     .topic = "/sportmodestate",
     .imu = "imu_state",
     .feet = "foot_position_body",
     .foot_speeds = "foot_speed_body",
     .contacts = "foot_force",
     .legs = kUnitree},
    motors_of_unitree("unitree_legged_msgs/LowState", "/low_state", "imu", Spelling::kCamelCase),
    motors_of_unitree("unitree_legged_msgs/LowState", "/low_state", "imu", Spelling::kSnakeCase),
    motors_of_unitree("unitree_legged_msgs/HighState", "/high_state", "imu", Spelling::kCamelCase),
    motors_of_unitree("unitree_legged_msgs/HighState", "/high_state", "imu", Spelling::kSnakeCase),
    {.type = "unitree_legged_msgs/HighState",
     .topic = "/high_state",
     .imu = "imu",
     .feet = "footPosition2Body[]",
     .foot_speeds = "footSpeed2Body[]",
     .contacts = "footForce",
     .legs = kUnitree},
    {.type = "anymal_msgs/AnymalState",
     .robot = "an ANYmal C",
     .topic = "/state_estimator/anymal_state",
     .angles = "joints.position",
     .rates = "joints.velocity",
     .joint_names = "joints.name",
     .contacts = "contacts[].state",
     .foot_names = "contacts[].name",
     .contact_kind = ContactKind::kState,
     .knee_offset = kAnymalKnee,
     .geometry = &kAnymalC},
    actuators_of_anymal("series_elastic_actuator_msgs/SeActuatorReadings"),
    actuators_of_anymal("anymal_msgs/SeActuatorReadings"),
    // The driver lists the feet as the robot does: front left, front right, hind left, hind right.
    {.type = "spot_msgs/FootStateArray",
     .topic = "/spot/status/feet",
     .feet = "states[].foot_position_rt_body",
     .contacts = "states[].contact",
     .contact_kind = ContactKind::kState},
    {.type = kFootPlaces, .feet = "place[]"},
    {.type = "unitree_hg/LowState",
     .robot = "a G1 with 29 joints",
     .topic = "/lowstate",
     .imu = "imu_state",
     .angles = "motor_state[].q",
     .rates = "motor_state[].dq",
     .contacts = "motor_state[].tau_est",
     .contact_kind = ContactKind::kTorque,
     .biped = &kG1},
});

std::vector<std::string_view> imus_of_all() {
  std::vector<std::string_view> imus;
  for (const StateLayout& state : kStates) {
    if (!state.imu.empty() && std::ranges::find(imus, state.imu) == imus.end()) {
      imus.push_back(state.imu);
    }
  }
  return imus;
}

/// Whether each name of the path is a word of the definition.
bool has_fields(std::string_view definition, std::string_view path) {
  while (!path.empty()) {
    const std::size_t end = std::min(path.find_first_of(".[]"), path.size());
    if (end > 0 && !has_word(definition, path.substr(0, end), "_")) return false;
    path.remove_prefix(std::min(end + 1, path.size()));
  }
  return true;
}

}  // namespace

std::span<const StateLayout> robot_states() { return kStates; }

const StateLayout* robot_state_of(std::string_view type, std::string_view definition) {
  for (const StateLayout& state : kStates) {
    if (state.type != type) continue;
    const auto paths = {state.imu,  state.angles,   state.rates,      state.joint_names,
                        state.feet, state.contacts, state.foot_names, state.foot_speeds};
    const bool fits = std::ranges::all_of(
        paths, [&](std::string_view path) { return has_fields(definition, path); });
    if (fits) return &state;
  }
  return nullptr;
}

bool is_robot_state_with_imu(std::string_view type) {
  return std::ranges::any_of(
      kStates, [&](const StateLayout& state) { return state.type == type && !state.imu.empty(); });
}

std::span<const std::string_view> robot_imus() {
  static const std::vector<std::string_view> imus = imus_of_all();
  return imus;
}

}  // namespace aims
