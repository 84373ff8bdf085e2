// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/leg_messages.hpp"

#include <cmath>

namespace aims {
namespace {

/// The numbers of an array, bytes too.
std::optional<std::vector<double>> numbers_at(const MessageView& message, std::string_view path) {
  if (auto numbers = message.numbers(path)) return numbers;
  const auto bytes = message.bytes(path);
  if (!bytes) return std::nullopt;
  std::vector<double> numbers;
  for (const std::byte each : *bytes) numbers.push_back(std::to_integer<int>(each));
  return numbers;
}

std::vector<std::string_view> names_at(const MessageView& message) {
  for (const std::string_view path : {"name", "foot", "names"}) {
    if (auto names = message.texts(path)) return *names;
  }
  return {};
}

/// The joints of a unitree_go/LowState: motors leg by leg, each abduction, hip, knee.
std::optional<JointReading> unitree_joints_at(const MessageView& message, Time record_time) {
  const auto motors = message.messages("motor_state");
  if (!motors || motors->size() < std::size_t{kJointCount}) return std::nullopt;
  JointReading reading;
  reading.stamp = header_stamp(message, record_time);
  reading.velocity.emplace();
  for (std::size_t i = 0; i < std::size_t{kJointCount}; ++i) {
    const auto angle = (*motors)[i].number("q");
    const auto rate = (*motors)[i].number("dq");
    if (!angle || !rate) return std::nullopt;
    const auto leg = static_cast<std::size_t>(*leg_of_name(kUnitreeFeet[i / 3]));
    reading.position[3 * leg + i % 3] = *angle;
    (*reading.velocity)[3 * leg + i % 3] = *rate;
  }
  return reading;
}

std::array<double, kJointCount> ordered(const std::vector<double>& values,
                                        const JointOrder& order) {
  std::array<double, kJointCount> result{};
  for (std::size_t i = 0; i < order.size(); ++i) result[i] = values[order[i]];
  return result;
}

}  // namespace

std::optional<LegOdometrySample> odometry_at(const MessageView& message, EventCounts& counts) {
  const auto stamp = message.time("header.stamp");
  const auto pose = message_pose(message, "pose.pose", counts);
  const auto linear = vector_at(message, "twist.twist.linear");
  const auto angular = vector_at(message, "twist.twist.angular");
  if (!stamp || !pose || !linear || !angular) return std::nullopt;
  LegOdometrySample sample;
  sample.stamp = *stamp;
  sample.T_odom_base = *pose;
  sample.linear_velocity = *linear;
  sample.angular_velocity = *angular;
  return sample;
}

std::optional<LegOdometrySample> twist_at(const MessageView& message, Time record_time) {
  LegOdometrySample sample;
  sample.stamp = header_stamp(message, record_time);
  for (const std::string prefix : {"twist.", "twist.twist.", ""}) {
    const auto linear = vector_at(message, prefix + "linear");
    const auto angular = vector_at(message, prefix + "angular");
    if (!linear || !angular) continue;
    sample.linear_velocity = *linear;
    sample.angular_velocity = *angular;
    return sample;
  }
  return std::nullopt;
}

std::optional<JointReading> joints_at(const MessageView& message, Time record_time,
                                      const JointRule& rule) {
  const auto position = message.numbers("position");
  if (!position) return unitree_joints_at(message, record_time);
  auto order = joint_order(names_at(message), rule.names, position->size());
  if (!order && position->size() == std::size_t{kJointCount}) order = rule.order;
  if (!order) return std::nullopt;
  JointReading reading;
  reading.stamp = header_stamp(message, record_time);
  reading.position = ordered(*position, *order);
  const auto velocity = message.numbers("velocity");
  if (velocity && velocity->size() == position->size()) {
    reading.velocity = ordered(*velocity, *order);
  }
  return reading;
}

std::optional<UnnamedJoints> unnamed_joints_at(const MessageView& message) {
  auto angles = message.numbers("position");
  const auto names = names_at(message);
  if (!angles || !joints_are_unnamed(names, angles->size())) return std::nullopt;
  return UnnamedJoints{std::move(*angles),
                       message.numbers("velocity").value_or(std::vector<double>()),
                       {names.begin(), names.end()}};
}

bool feet_are_named(const MessageView& message, const ContactRule& rule) {
  const auto numbers = numbers_at(message, rule.field);
  return numbers && named_foot_order(names_at(message), rule.foot_names, numbers->size());
}

std::optional<FootLoads> loads_at(const MessageView& message, const ContactRule& rule) {
  const auto numbers = numbers_at(message, rule.field);
  if (!numbers) return std::nullopt;
  const auto order = foot_order(names_at(message), rule.foot_names, numbers->size());
  if (!order) return std::nullopt;
  FootLoads loads{};
  for (std::size_t i = 0; i < order->size(); ++i) {
    if ((*order)[i] >= 0) loads[static_cast<std::size_t>((*order)[i])] = (*numbers)[i];
  }
  return loads;
}

std::optional<FootLoads> forces_at(const MessageView& message, const ContactRule& rule) {
  if (!message.texts("foot")) return std::nullopt;
  return loads_at(message, {"force", {}, rule.foot_names});
}

std::optional<FeetReading> feet_at(const MessageView& message, Time record_time) {
  const auto position = message.numbers("foot_position_body");
  const auto velocity = message.numbers("foot_speed_body");
  constexpr std::size_t kNumbers = 3 * std::size_t{kLegCount};
  if (!position || !velocity || position->size() != kNumbers || velocity->size() != kNumbers) {
    return std::nullopt;
  }
  FeetReading reading;
  reading.stamp = header_stamp(message, record_time);
  for (std::size_t i = 0; i < kUnitreeFeet.size(); ++i) {
    const auto leg = static_cast<std::size_t>(*leg_of_name(kUnitreeFeet[i]));
    reading.position[leg] = Eigen::Vector3d(&(*position)[3 * i]);
    reading.velocity[leg] = Eigen::Vector3d(&(*velocity)[3 * i]);
  }
  return reading;
}

}  // namespace aims
