// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/leg_messages.hpp"

#include <cmath>

#include "recordings/legs/biped_legs.hpp"

namespace aims {
namespace {

/// The number of a foot that stands, and does not slip: anymal_msgs/Contact STATE_CLOSED,
/// spot_msgs/FootState CONTACT_MADE.
constexpr double kStands = 1.0;

/// The names that belong to the numbers at `path`.
std::vector<std::string_view> names_at(const MessageView& message, std::string_view path = {}) {
  const std::size_t entries = path.find("[]");
  if (entries != std::string_view::npos) {
    const std::string names = std::string(path.substr(0, entries)) + "[].name";
    return texts_at(message, names).value_or(std::vector<std::string_view>());
  }
  for (const std::string_view each : {"name", "foot", "names"}) {
    if (auto names = message.texts(each)) return *names;
  }
  return {};
}

std::vector<std::string_view> foot_names_at(const MessageView& message, const ContactRule& rule) {
  if (rule.state == nullptr || rule.state->foot_names.empty()) return names_at(message, rule.field);
  return texts_at(message, rule.state->foot_names).value_or(std::vector<std::string_view>());
}

std::string_view angles_path(const StateLayout* state) {
  return state == nullptr ? "position" : state->angles;
}

std::string_view rates_path(const StateLayout* state) {
  return state == nullptr ? "velocity" : state->rates;
}

/// The first twelve of the numbers are the joints, leg by leg.
JointOrder order_of_legs(const std::array<int, kLegCount>& legs) {
  JointOrder order{};
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[3 * static_cast<std::size_t>(legs[i / 3]) + i % 3] = i;
  }
  return order;
}

std::array<double, kJointCount> ordered(const std::vector<double>& values, const JointOrder& order,
                                        double scale) {
  std::array<double, kJointCount> result{};
  for (std::size_t i = 0; i < order.size(); ++i) result[i] = scale * values[order[i]];
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

std::vector<std::string_view> joint_names_at(const MessageView& message, const StateLayout* state) {
  if (state == nullptr) return names_at(message);
  return texts_at(message, state->joint_names).value_or(std::vector<std::string_view>());
}

std::optional<JointReading> joints_at(const MessageView& message, Time record_time,
                                      const JointRule& rule) {
  const auto position = numbers_at(message, angles_path(rule.state));
  if (!position) return std::nullopt;
  const bool named = rule.state == nullptr || !rule.state->joint_names.empty();
  std::optional<JointOrder> order;
  if (named) {
    order = joint_order(joint_names_at(message, rule.state), rule.names, position->size());
    if (!order && position->size() == std::size_t{kJointCount}) order = rule.order;
  } else if (position->size() >= std::size_t{kJointCount}) {
    order = order_of_legs(rule.state->legs);
  }
  if (!order) return std::nullopt;
  JointReading reading;
  reading.stamp = header_stamp(message, record_time);
  reading.position = ordered(*position, *order, rule.scale);
  const double knee = rule.state == nullptr ? 0.0 : rule.state->knee_offset;
  for (std::size_t leg = 0; leg < std::size_t{kLegCount}; ++leg) {
    reading.position[3 * leg + 2] += leg < 2 ? knee : -knee;
  }
  const auto velocity = numbers_at(message, rates_path(rule.state));
  if (velocity && velocity->size() == position->size()) {
    reading.velocity = ordered(*velocity, *order, rule.scale);
  }
  return reading;
}

std::optional<UnnamedJoints> unnamed_joints_at(const MessageView& message, const JointRule& rule) {
  // The mean angles tell hips and knees of Unitree's convention alone.
  if (rule.state != nullptr &&
      (rule.state->joint_names.empty() || rule.state->knee_offset != 0.0)) {
    return std::nullopt;
  }
  auto angles = numbers_at(message, angles_path(rule.state));
  const auto names = joint_names_at(message, rule.state);
  if (!angles || !joints_are_unnamed(names, angles->size())) return std::nullopt;
  auto rates = numbers_at(message, rates_path(rule.state)).value_or(std::vector<double>());
  for (std::vector<double>* each : {&*angles, &rates}) {
    for (double& number : *each) number *= rule.scale;
  }
  return UnnamedJoints{std::move(*angles), std::move(rates), {names.begin(), names.end()}};
}

bool feet_are_named(const MessageView& message, const ContactRule& rule) {
  if (rule.knees != nullptr) return true;
  if (rule.state != nullptr && rule.state->foot_names.empty()) return true;
  const auto numbers = numbers_at(message, rule.field);
  return numbers &&
         named_foot_order(foot_names_at(message, rule), rule.foot_names, numbers->size());
}

std::optional<FootLoads> loads_at(const MessageView& message, const ContactRule& rule) {
  const auto numbers = numbers_at(message, rule.field);
  if (!numbers) return std::nullopt;
  if (rule.state != nullptr && rule.state->biped != nullptr) {
    return knee_torques(*numbers, *rule.state->biped);
  }
  FootLoads loads{};
  if (rule.knees != nullptr) {
    if (numbers->size() < std::size_t{kJointCount}) return std::nullopt;
    const JointOrder joints = order_of_legs(rule.knees->legs);
    for (std::size_t leg = 0; leg < loads.size(); ++leg) {
      loads[leg] = (*numbers)[joints[3 * leg + 2]];
    }
    return loads;
  }
  const auto order = foot_order(foot_names_at(message, rule), rule.foot_names, numbers->size());
  if (!order) return std::nullopt;
  const bool states = rule.state != nullptr && rule.state->contact_kind == ContactKind::kState;
  for (std::size_t i = 0; i < order->size(); ++i) {
    if ((*order)[i] < 0) continue;
    const double number = (*numbers)[i];
    loads[static_cast<std::size_t>((*order)[i])] =
        states ? (number == kStands ? 1.0 : 0.0) : number;
  }
  return loads;
}

std::optional<FootLoads> forces_at(const MessageView& message, const ContactRule& rule) {
  if (!message.texts("foot")) return std::nullopt;
  auto forces = loads_at(message, {"force", {}, rule.foot_names});
  if (!forces) return std::nullopt;
  for (std::size_t leg = 0; leg < forces->size(); ++leg) (*forces)[leg] *= rule.force_signs[leg];
  return forces;
}

std::optional<FeetReading> feet_at(const MessageView& message, Time record_time,
                                   const StateLayout& state) {
  const Time stamp = header_stamp(message, record_time);
  if (state.biped != nullptr) {
    const auto angles = numbers_at(message, state.angles);
    const auto rates = numbers_at(message, state.rates);
    return angles && rates ? biped_feet(*state.biped, stamp, *angles, *rates) : std::nullopt;
  }
  const auto places = points_at(message, state.feet);
  if (!places || places->size() != std::size_t{kLegCount}) return std::nullopt;
  const auto speeds =
      state.foot_speeds.empty()
          ? std::vector<Eigen::Vector3d>(places->size())
          : points_at(message, state.foot_speeds).value_or(std::vector<Eigen::Vector3d>());
  if (speeds.size() != places->size()) return std::nullopt;
  FeetReading reading;
  reading.stamp = stamp;
  reading.has_velocity = !state.foot_speeds.empty();
  for (std::size_t i = 0; i < places->size(); ++i) {
    const auto leg = static_cast<std::size_t>(state.legs[i]);
    reading.position[leg] = (*places)[i];
    reading.velocity[leg] = reading.has_velocity ? speeds[i] : Eigen::Vector3d::Zero();
  }
  return reading;
}

}  // namespace aims
