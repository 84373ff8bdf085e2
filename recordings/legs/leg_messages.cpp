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
                                      const std::vector<std::string>& joint_names) {
  const auto position = message.numbers("position");
  if (!position) return std::nullopt;
  const auto order = joint_order(names_at(message), joint_names, position->size());
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

std::optional<std::array<double, kLegCount>> loads_at(const MessageView& message,
                                                      const ContactRule& rule) {
  const auto numbers = numbers_at(message, rule.field);
  if (!numbers) return std::nullopt;
  const auto order = foot_order(names_at(message), rule.foot_names, numbers->size());
  if (!order) return std::nullopt;
  std::array<double, kLegCount> loads{};
  for (std::size_t i = 0; i < order->size(); ++i) {
    if ((*order)[i] >= 0) loads[static_cast<std::size_t>((*order)[i])] = (*numbers)[i];
  }
  return loads;
}

std::optional<ContactReading> contacts_at(const MessageView& message, Time record_time,
                                          const ContactRule& rule) {
  const auto loads = loads_at(message, rule);
  if (!loads) return std::nullopt;
  ContactReading reading;
  reading.stamp = header_stamp(message, record_time);
  for (std::size_t leg = 0; leg < loads->size(); ++leg) {
    // The torque of a loaded knee has either sign.
    reading.contact[leg] = std::abs((*loads)[leg]) >= rule.threshold;
  }
  return reading;
}

}  // namespace aims
