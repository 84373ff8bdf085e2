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

#include "core/leg_kinematics.hpp"
#include "core/text.hpp"
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
  const std::string lower = lower_case(text);
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
  LegFields fields(connection.topic, connection.type, *decoder);
  if (!fields.has_angles() && !fields.has_load() && !fields.has_place()) return std::nullopt;
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
    part.name = part.recorded = named->leg ? named->id : "leg" + named->id;
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
    group.places = each.fields.has_place() && !group.joints;
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

/// The leg of a message that names it; nothing where it does not.
std::optional<LegPart> part_of(const LegPartSample& sample, const LegFields& fields) {
  const auto named = named_leg(sample.leg);
  LegPart part;
  if (named) {
    part.leg = named->leg;
    part.recorded = named->leg ? named->id : "leg" + named->id;
  } else if (fields.has_leg() && !sample.leg.empty()) {
    part.recorded = "leg" + sample.leg;
  } else {
    return std::nullopt;
  }
  part.name = part.recorded;
  return part;
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
  found.places = candidate.fields.has_place() && !found.joints;
  found.text = fmt::format("{}, whose messages name their leg", found.topic);
  return found;
}

/// A topic whose messages hold the loads of all feet, each in a field that names its leg.
LegTopics named_loads(const BagConnection& connection, FeetPaths paths) {
  LegTopics found;
  found.feet = std::move(paths);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    LegPart part;
    part.connection = connection.id;
    part.name = part.recorded = kLegNames[leg];
    part.leg = static_cast<int>(leg);
    part.entry = leg;
    found.parts.push_back(std::move(part));
  }
  found.topic = connection.topic;
  found.loads = true;
  found.text = fmt::format("{}, whose fields name the feet", found.topic);
  return found;
}

/// A topic whose messages hold all feet in arrays.
std::optional<LegTopics> topic_of_feet(MessageSource& source, const BagConnection& connection) {
  if (connection.messages == 0 || connection.type.starts_with("aims_msgs/")) return std::nullopt;
  if (robot_state_of(connection.type, connection.definition) != nullptr) return std::nullopt;
  const auto decoder =
      MessageDecoder::create(connection.type, connection.definition, connection.format);
  if (!decoder) return std::nullopt;
  if (may_be_of_legs(connection)) {
    if (auto loads = loads_by_name(*decoder)) return named_loads(connection, std::move(*loads));
  }
  if (!may_hold_feet(connection, *decoder)) return std::nullopt;
  source.select(std::vector<std::string>{connection.topic});
  source.rewind();
  const auto message = source.next();
  if (!message || !*message || (*message)->connection->id != connection.id) return std::nullopt;
  const auto view = decoder->decode((*message)->data);
  LegTopics found;
  if (view) found.feet = feet_paths(connection, *decoder, *view);
  if (!found.feet) return std::nullopt;
  for (std::size_t entry = 0; entry < kLegs; ++entry) {
    LegPart part;
    part.connection = connection.id;
    part.name = fmt::format("foot{}", entry);
    part.entry = entry;
    found.parts.push_back(std::move(part));
  }
  found.topic = connection.topic;
  found.places = true;
  found.loads = !found.feet->loads.empty();
  found.text = fmt::format("{}, whose messages hold all feet", found.topic);
  return found;
}

/// The first samples of the parts of a group, by part.
std::vector<std::vector<LegPartSample>> first_samples(MessageSource& source,
                                                      const LegTopics& group) {
  std::map<std::uint32_t, Candidate> by_id;
  std::vector<std::string> topics;
  for (const BagConnection& each : source.connections()) {
    const bool is_part = std::ranges::any_of(
        group.parts, [&](const LegPart& part) { return part.connection == each.id; });
    auto decoder = MessageDecoder::create(each.type, each.definition, each.format);
    if (!is_part || !decoder) continue;
    LegFields fields(each.topic, each.type, *decoder);
    by_id.emplace(each.id, Candidate{&each, std::move(*decoder), std::move(fields)});
    topics.push_back(each.topic);
  }
  source.select(topics);
  source.rewind();
  std::vector<std::vector<LegPartSample>> samples(group.parts.size());
  for (int i = 0; i < kFirstMessages; ++i) {
    const auto message = source.next();
    if (!message || !*message) break;
    const auto at = by_id.find((*message)->connection->id);
    if (at == by_id.end()) continue;
    const auto view = at->second.decoder.decode((*message)->data);
    if (!view) continue;
    for (auto& [part, sample] : samples_of(group, at->second.fields, at->first, *view, 0)) {
      samples[part].push_back(std::move(sample));
    }
  }
  return samples;
}

/// Whether the loads are flags, few of which repeat the one before of their foot.
bool is_on_change(const std::vector<std::vector<LegPartSample>>& samples) {
  constexpr int kFewRepeats = 10;  // one of so many
  int messages = 0, repeats = 0;
  for (const std::vector<LegPartSample>& of_part : samples) {
    std::optional<double> before;
    for (const LegPartSample& each : of_part) {
      const double load = each.load.value_or(-1.0);
      if (load != 0.0 && load != 1.0) return false;
      ++messages;
      if (std::exchange(before, load) == load) ++repeats;
    }
  }
  return kFewRepeats * repeats <= messages;
}

/// The leg of each part by the quarter of the base in which its foot is in the mean: x forward, y
/// left. None where two are in one.
std::vector<int> legs_by_place(const std::vector<std::vector<LegPartSample>>& samples) {
  std::vector<int> legs;
  for (const std::vector<LegPartSample>& of_part : samples) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const LegPartSample& each : of_part) {
      if (each.place && each.place->allFinite()) sum += *each.place;
    }
    const int leg = (sum.x() > 0.0 ? 0 : 2) + (sum.y() > 0.0 ? 0 : 1);
    if (std::ranges::find(legs, leg) != legs.end()) return {};
    legs.push_back(leg);
  }
  return legs;
}

/// Finds the legs of feet that have no names by their places, also of other groups that number them
/// likewise.
void name_by_place(MessageSource& source, std::vector<LegTopics>& groups) {
  std::map<std::string, int> known;  // by the name before
  for (LegTopics& each : groups) {
    const auto unnamed = [](const LegPart& part) { return !part.leg; };
    if (!each.places || !std::ranges::all_of(each.parts, unnamed)) continue;
    const std::vector<int> legs = legs_by_place(first_samples(source, each));
    std::vector<std::string> names;
    for (std::size_t i = 0; i < each.parts.size(); ++i) {
      // Without a clear order the usual one; the places are judged later.
      const int leg = legs.empty() ? static_cast<int>(i) : legs[i];
      names.emplace_back(kLegNames[static_cast<std::size_t>(leg)]);
      if (!each.feet) known[each.parts[i].name] = leg;
      each.parts[i].leg = leg;
      each.parts[i].name = names.back();
    }
    each.text += fmt::format(" ({} in their order, {})", fmt::join(names, " "),
                             legs.empty() ? "as is usual" : "by their places");
  }
  for (LegTopics& each : groups) {
    for (LegPart& part : each.parts) {
      const auto leg = known.find(part.name);
      if (part.leg || leg == known.end()) continue;
      part.leg = leg->second;
      part.name = kLegNames[static_cast<std::size_t>(leg->second)];
    }
  }
}

/// The part of a sample; nothing for a leg that is none of them.
std::optional<std::size_t> part_index(const LegTopics& topics, const LegFields& fields,
                                      std::uint32_t connection, const LegPartSample& sample) {
  const auto of_topic = [&](const LegPart& each) { return each.connection == connection; };
  const auto first = std::ranges::find_if(topics.parts, of_topic);
  if (first == topics.parts.end()) return std::nullopt;
  std::optional<LegPart> named = *first;
  if (std::ranges::count_if(topics.parts, of_topic) > 1) named = part_of(sample, fields);
  if (!named) return std::nullopt;
  const auto at = std::ranges::find_if(topics.parts, [&](const LegPart& each) {
    return of_topic(each) && each.recorded == named->recorded && each.joint == named->joint;
  });
  if (at == topics.parts.end()) return std::nullopt;
  return static_cast<std::size_t>(at - topics.parts.begin());
}

}  // namespace

bool may_be_of_legs(const BagConnection& connection) {
  constexpr auto kWords = std::to_array<std::string_view>(
      {"joint", "contact", "foot", "feet", "force", "leg", "limb", "wrench", "motor", "touch"});
  constexpr auto kStance = std::to_array<std::string_view>({"stance"}),
                 kDistance = std::to_array<std::string_view>({"distance"});
  if (connection.type.starts_with("sensor_msgs/"))
    return connection.type == "sensor_msgs/JointState";
  const std::string both = connection.topic + " " + connection.type;
  return holds_any(both, kWords) || (holds_any(both, kStance) && !holds_any(both, kDistance));
}

std::vector<std::pair<std::size_t, LegPartSample>> samples_of(const LegTopics& topics,
                                                              const LegFields& fields,
                                                              std::uint32_t connection,
                                                              const MessageView& message,
                                                              Time time) {
  std::vector<std::pair<std::size_t, LegPartSample>> found;
  if (topics.feet) {
    const std::vector<LegPartSample> feet = feet_in(message, *topics.feet, time);
    for (std::size_t i = 0; i < topics.parts.size() && !feet.empty(); ++i) {
      found.emplace_back(i, feet[topics.parts[i].entry]);
    }
    return found;
  }
  auto sample = fields.read(message, time);
  const auto part = sample ? part_index(topics, fields, connection, *sample) : std::nullopt;
  if (part) found.emplace_back(*part, std::move(*sample));
  return found;
}

std::vector<LegTopics> find_leg_topics(MessageSource& source) {
  std::vector<Candidate> candidates;
  const std::vector<BagConnection>& all = source.connections();
  for (const BagConnection& each : all) {
    if (auto candidate = candidate_of(each)) candidates.push_back(std::move(*candidate));
  }
  std::vector<LegTopics> found = topics_of_single_legs(candidates);
  for (const Candidate& each : candidates) {
    if (auto topics = topic_of_all_legs(source, each)) found.push_back(std::move(*topics));
  }
  for (const BagConnection& each : all) {
    const bool is_part = std::ranges::any_of(found, [&each](const LegTopics& topics) {
      return std::ranges::any_of(
          topics.parts, [&each](const LegPart& part) { return part.connection == each.id; });
    });
    if (is_part) continue;
    if (auto topics = topic_of_feet(source, each)) found.push_back(std::move(*topics));
  }
  for (LegTopics& each : found) {
    each.on_change =
        each.loads && !each.joints && !each.places && is_on_change(first_samples(source, each));
  }
  name_by_place(source, found);
  start_anew(source);
  for (LegTopics& each : found) {
    number_legs(each.parts);
    std::ranges::stable_sort(each.parts, {}, [](const LegPart& part) {
      return std::pair(part.number, part.joint.value_or(-1));
    });
  }
  return found;
}

}  // namespace aims
