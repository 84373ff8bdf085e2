// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/leg_topics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>

#include "recordings/legs/leg_names.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/messages/robot_states.hpp"

namespace aims {
namespace {

constexpr std::size_t kLegs = kLegCount;
constexpr int kFirstMessages = 400;  ///< in which each leg occurs
constexpr std::size_t kJoints = 3;   ///< of a leg
constexpr std::size_t kMostListed = 4;

bool holds_any(std::string_view text, std::span<const std::string_view> parts) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::any_of(
      parts, [&](std::string_view part) { return lower.find(part) != std::string::npos; });
}

struct Candidate {
  const BagConnection* connection = nullptr;
  MessageDecoder decoder;
  LegFields fields;
};

/// A topic whose messages may be of one leg each.
std::optional<Candidate> candidate_of(const BagConnection& connection) {
  if (connection.messages == 0 || !may_be_of_legs(connection)) return std::nullopt;
  if (robot_state_of(connection.type, connection.definition) != nullptr) return std::nullopt;
  auto decoder = MessageDecoder::create(connection.type, connection.definition, connection.format);
  if (!decoder) return std::nullopt;
  LegFields fields(connection.type, *decoder);
  if (!fields.has_angles() && !fields.has_load()) return std::nullopt;
  return Candidate{&connection, std::move(*decoder), std::move(fields)};
}

/// What is left of a name without the word of a joint, and that joint.
std::pair<std::string, std::optional<int>> without_joint(const std::string& rest) {
  const auto joint = joint_of_name(rest);
  if (!joint) return {rest, std::nullopt};
  std::string name;
  bool part_begins = false;  // with the word that is left out
  for (std::size_t begin = 0; begin < rest.size();) {
    const std::size_t end = std::min(rest.find_first_of("/_", begin + 1), rest.size());
    const std::string word = rest.substr(begin, end - begin);
    const bool separated = part_begins && word.front() == '_';
    if (joint_of_name(word) == joint) {
      part_begins = word.front() == '/';
    } else {
      name += separated ? "/" + word.substr(1) : word;
      part_begins = false;
    }
    begin = end;
  }
  return {name, joint};
}

/// Orders the legs: those whose place is known as FL, FR, RL, RR, others by their numbers.
void number_legs(std::vector<LegPart>& parts) {
  std::set<std::pair<int, std::string>> legs;
  for (const LegPart& each : parts) legs.emplace(each.leg.value_or(-1), each.name);
  for (LegPart& each : parts) {
    const auto at = legs.find({each.leg.value_or(-1), each.name});
    each.number = static_cast<std::size_t>(std::distance(legs.begin(), at));
  }
}

/// Whether the parts are four legs, each whole.
bool is_complete(const std::vector<LegPart>& parts) {
  std::set<std::string> legs;
  std::set<std::pair<std::string, int>> joints;
  bool single = false;
  for (const LegPart& each : parts) {
    legs.insert(each.name);
    joints.emplace(each.name, each.joint.value_or(-1));
    single = single || each.joint;
  }
  return legs.size() == kLegs && joints.size() == parts.size() &&
         parts.size() == (single ? kLegs * kJoints : kLegs);
}

/// Topics that differ in the leg alone.
std::vector<LegTopics> topics_of_single_legs(const std::vector<Candidate>& candidates) {
  using Key = std::tuple<std::string, std::string, bool>;  // name, type, of single joints
  std::map<Key, LegTopics> groups;
  for (const Candidate& each : candidates) {
    const BagConnection& connection = *each.connection;
    const auto named = named_leg(connection.topic);
    if (!named) continue;
    LegPart part;
    part.connection = connection.id;
    part.leg = named->leg;
    part.name = named->leg ? named->id : "leg" + named->id;
    std::string name = named->rest;
    if (each.fields.is_one_joint()) {
      const auto [rest, joint] = without_joint(named->rest);
      if (!joint) continue;
      name = rest;
      part.joint = joint;
    }
    LegTopics& group = groups[{name, connection.type, part.joint.has_value()}];
    group.topic = name;
    group.parts.push_back(std::move(part));
    group.joints = each.fields.has_angles();
    group.loads = each.fields.has_load() && !each.fields.is_one_joint();
    if (group.parts.size() <= kMostListed) {
      group.text += (group.text.empty() ? "" : ", ") + connection.topic;
    }
  }
  std::vector<LegTopics> found;
  for (auto& [key, group] : groups) {
    if (!is_complete(group.parts)) continue;
    const std::size_t more = group.parts.size() - kMostListed;
    if (more > 0) group.text += fmt::format(" and {} more", more);
    found.push_back(std::move(group));
  }
  return found;
}

/// The legs that the first messages of a topic name; none where one names no leg.
std::vector<LegPart> legs_in(MessageSource& source, const Candidate& candidate) {
  source.select(std::vector<std::string>{candidate.connection->topic});
  source.rewind();
  std::map<std::string, LegPart> legs;
  for (int i = 0; i < kFirstMessages; ++i) {
    const auto message = source.next();  // a broken file is reported where it is read
    if (!message || !*message) break;
    if ((*message)->connection->id != candidate.connection->id) continue;
    const auto view = candidate.decoder.decode((*message)->data);
    const auto sample = view ? candidate.fields.read(*view, 0) : std::nullopt;
    if (!sample) continue;
    auto part = part_of(*sample, candidate.fields);
    if (!part || legs.size() > kLegs) return {};
    part->connection = candidate.connection->id;
    legs.emplace(part->name, std::move(*part));
  }
  std::vector<LegPart> parts;
  for (auto& [name, part] : legs) parts.push_back(std::move(part));
  return parts;
}

/// A topic whose messages name their leg.
std::optional<LegTopics> topic_of_all_legs(MessageSource& source, const Candidate& candidate) {
  if (candidate.fields.is_one_joint() || named_leg(candidate.connection->topic)) {
    return std::nullopt;
  }
  LegTopics found;
  found.parts = legs_in(source, candidate);
  if (!is_complete(found.parts)) return std::nullopt;
  found.topic = candidate.connection->topic;
  found.joints = candidate.fields.has_angles();
  found.loads = candidate.fields.has_load();
  found.text = fmt::format("{}, whose messages name their leg", found.topic);
  return found;
}

}  // namespace

bool may_be_of_legs(const BagConnection& connection) {
  constexpr auto kWords = std::to_array<std::string_view>(
      {"joint", "contact", "foot", "feet", "force", "leg", "limb", "wrench", "motor", "touch"});
  if (connection.type.starts_with("sensor_msgs/"))
    return connection.type == "sensor_msgs/JointState";
  return holds_any(connection.topic, kWords) || holds_any(connection.type, kWords);
}

std::optional<LegPart> part_of(const LegPartSample& sample, const LegFields& fields) {
  const auto named = named_leg(sample.leg);
  LegPart part;
  if (named) {
    part.leg = named->leg;
    part.name = named->leg ? named->id : "leg" + named->id;
  } else if (fields.has_leg() && !sample.leg.empty()) {
    part.name = "leg" + sample.leg;
  } else {
    return std::nullopt;
  }
  return part;
}

std::vector<LegTopics> find_leg_topics(MessageSource& source) {
  std::vector<Candidate> candidates;
  const std::vector<BagConnection>& all = source.connections();
  for (const BagConnection& each : all) {
    if (auto candidate = candidate_of(each)) candidates.push_back(std::move(*candidate));
  }
  if (candidates.empty()) return {};
  std::vector<LegTopics> found = topics_of_single_legs(candidates);
  for (const Candidate& each : candidates) {
    if (auto topics = topic_of_all_legs(source, each)) found.push_back(std::move(*topics));
  }
  std::set<std::string> topics;
  for (const BagConnection& each : all) topics.insert(each.topic);
  source.select(std::vector<std::string>(topics.begin(), topics.end()));
  source.rewind();
  for (LegTopics& each : found) {
    number_legs(each.parts);
    std::ranges::stable_sort(each.parts, {}, [](const LegPart& part) {
      return std::pair(part.number, part.joint.value_or(-1));
    });
  }
  return found;
}

}  // namespace aims
