// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/single_legs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <vector>

#include "recordings/legs/leg_names.hpp"
#include "recordings/messages/robot_states.hpp"
#include "recordings/source/leg_topics.hpp"

namespace aims {
namespace {

constexpr std::string_view kExpected =
    "they are not joined: that needs a file with all four legs, each with its joints or the load "
    "of its foot; else put all legs in one message (docs: Legs in messages of their own)";

/// Whether the messages say themselves of which leg they are.
bool names_its_leg(const BagConnection& connection) {
  constexpr auto kFields = std::to_array<std::string_view>(
      {" leg_id\n", " leg_index\n", " leg_name\n", " leg\n", " foot_id\n", " foot_name\n"});
  if (robot_state_of(connection.type, connection.definition) != nullptr) return false;
  // Of the message itself: the types that it uses follow behind a line of equals signs.
  const std::string own = connection.definition.substr(0, connection.definition.find("\n==="));
  return std::ranges::any_of(kFields, [&own](std::string_view field) {
    return (own + "\n").find(field) != std::string::npos;
  });
}

}  // namespace

std::string single_legs_text(std::span<const BagConnection> connections) {
  std::map<std::string, std::map<int, std::string>> topics;  // by type, then by leg
  for (const BagConnection& each : connections) {
    if (each.messages == 0 || each.is_part) continue;
    if (names_its_leg(each)) {
      return fmt::format("{} ({}) holds one leg in each message: {}", each.topic, each.type,
                         kExpected);
    }
    const auto leg = may_be_of_legs(each) ? leg_of_name(each.topic) : std::nullopt;
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
