// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/single_legs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <string_view>
#include <vector>

#include "recordings/legs/leg_names.hpp"
#include "recordings/messages/robot_states.hpp"

namespace aims {
namespace {

constexpr std::string_view kExpected =
    "expected all legs in one message: sensor_msgs/JointState of twelve joints, and contacts with "
    "a number for each foot; join them before (docs: Legs without odometry)";

bool holds_any(std::string_view text, std::span<const std::string_view> parts) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::any_of(
      parts, [&](std::string_view part) { return lower.find(part) != std::string::npos; });
}

/// Whether a topic may be of joints or feet, by its type and name.
bool is_of_legs(const BagConnection& connection) {
  constexpr auto kWords = std::to_array<std::string_view>(
      {"joint", "contact", "foot", "feet", "force", "leg", "wrench", "motor"});
  if (connection.type.starts_with("sensor_msgs/"))
    return connection.type == "sensor_msgs/JointState";
  return holds_any(connection.topic, kWords) || holds_any(connection.type, kWords);
}

/// Whether the messages say themselves of which leg they are.
bool names_its_leg(const BagConnection& connection) {
  constexpr auto kFields = std::to_array<std::string_view>(
      {" leg_id\n", " leg_index\n", " leg_name\n", " leg\n", " foot_id\n", " foot_name\n"});
  if (robot_state_of(connection.type, connection.definition) != nullptr) return false;
  // Of the message itself: the types that it uses follow behind a line of equals signs.
  const std::string own = connection.definition.substr(0, connection.definition.find("\n==="));
  return holds_any(own + "\n", kFields);
}

}  // namespace

std::string single_legs_text(std::span<const BagConnection> connections) {
  std::map<std::string, std::map<int, std::string>> topics;  // by type, then by leg
  for (const BagConnection& each : connections) {
    if (each.messages == 0) continue;
    if (names_its_leg(each)) {
      return fmt::format("{} ({}) holds one leg in each message: {}", each.topic, each.type,
                         kExpected);
    }
    const auto leg = is_of_legs(each) ? leg_of_name(each.topic) : std::nullopt;
    if (leg) topics[each.type].emplace(*leg, each.topic);
  }
  for (const auto& [type, of_type] : topics) {
    if (of_type.size() < 2) continue;
    std::vector<std::string> names;
    for (const auto& [leg, topic] : of_type) names.push_back(topic);
    return fmt::format("{} ({}) hold one leg each: {}", fmt::join(names, ", "), type, kExpected);
  }
  return {};
}

}  // namespace aims
