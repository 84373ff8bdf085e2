// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/joined_legs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "recordings/legs/leg_names.hpp"
#include "recordings/messages/message_bytes.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/messages/message_types.hpp"
#include "recordings/source/derived_source.hpp"
#include "recordings/source/leg_topics.hpp"
#include "recordings/source/part_joiner.hpp"

namespace aims {
namespace {

constexpr std::array<std::string_view, 3> kJointNames = {"hip", "thigh", "calf"};

/// Of a leg that is silent.
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// The legs, or joints, of which a set has a sample each.
using Parts = std::vector<LegPart>;

/// The name of a joint with that of its leg, which the recorded one may lack.
std::string joint_name(const LegPart& part, const std::vector<std::string>& names, std::size_t i) {
  if (part.joint) {
    return fmt::format("{}_{}_joint", part.name,
                       kJointNames[static_cast<std::size_t>(*part.joint)]);
  }
  if (i >= names.size()) return fmt::format("{}_{}", part.name, i);
  if (part.leg && leg_of_name(names[i]) == part.leg) return names[i];
  return fmt::format("{}_{}", part.name, names[i]);
}

void put_header(MessageBytes& out, Time stamp) {
  out.put(std::uint32_t{0});
  out.time(stamp);
  out.text("");
}

/// The joints of all legs.
MessageBytes joints_message(const Parts& parts, const JoinedParts& set) {
  std::vector<std::string> names;
  std::vector<double> angles, rates, efforts;
  bool all_rates = true, all_efforts = true;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const LegPartSample& each = *set.samples[i];
    all_rates = all_rates && each.rates.size() == each.angles.size();
    all_efforts = all_efforts && each.efforts.size() == each.angles.size();
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const LegPartSample& each = *set.samples[i];
    for (std::size_t joint = 0; joint < each.angles.size(); ++joint) {
      names.push_back(joint_name(parts[i], each.names, joint));
      angles.push_back(set.silent[i] ? kUnknown : each.angles[joint]);
      if (all_rates) rates.push_back(set.silent[i] ? kUnknown : each.rates[joint]);
      if (all_efforts) efforts.push_back(each.efforts[joint]);
    }
  }
  MessageBytes out;
  put_header(out, set.time);
  out.length(names.size());
  for (const std::string& name : names) out.text(name);
  for (const auto* each : {&angles, &rates, &efforts}) out.array(*each);
  return out;
}

MessageBytes loads_message(const std::vector<std::string>& feet, const std::vector<double>& loads,
                           Time stamp) {
  MessageBytes out;
  put_header(out, stamp);
  out.length(feet.size());
  for (const std::string& foot : feet) out.text(foot);
  out.array(loads);
  return out;
}

/// The parts of messages of one type, and the sets that they make.
struct PartTopic {
  LegTopics topics;
  LegFields fields;
  std::map<std::uint32_t, MessageDecoder> decoders;
  PartJoiner joiner;

  /// The part of a message of that topic.
  std::optional<std::size_t> part_of(const BagMessage& message, const LegPartSample& sample) const {
    const auto of_topic = [&](const LegPart& each) {
      return each.connection == message.connection->id;
    };
    const auto first = std::ranges::find_if(topics.parts, of_topic);
    if (first == topics.parts.end()) return std::nullopt;
    const bool shared = std::ranges::count_if(topics.parts, of_topic) > 1;
    const auto named = shared ? aims::part_of(sample, fields) : std::optional(*first);
    if (!named) return std::nullopt;
    const auto at = std::ranges::find_if(topics.parts, [&](const LegPart& each) {
      return of_topic(each) && each.name == named->name && each.joint == named->joint;
    });
    if (at == topics.parts.end()) return std::nullopt;
    return static_cast<std::size_t>(at - topics.parts.begin());
  }

  bool add(const BagMessage& message) {
    const auto decoder = decoders.find(message.connection->id);
    if (decoder == decoders.end()) return false;
    const auto view = decoder->second.decode(message.data);
    auto sample = view ? fields.read(*view, message.taken()) : std::nullopt;
    const auto part = sample ? part_of(message, *sample) : std::nullopt;
    if (!part || sample->time < 0) return false;
    if (topics.joints && sample->angles.empty()) return false;
    if (topics.loads && !sample->load) return false;
    joiner.add(*part, std::move(*sample));
    return true;
  }
};

class JoinedLegs final : public DerivedSource {
 public:
  JoinedLegs(std::unique_ptr<MessageSource> source, std::vector<PartTopic> topics)
      : DerivedSource(std::move(source)), topics_(std::move(topics)) {
    for (PartTopic& each : topics_) {
      std::set<std::uint32_t> from;
      for (const LegPart& part : each.topics.parts) from.insert(part.connection);
      const std::uint64_t messages = mark_parts(from) / each.topics.parts.size();
      Made made;
      const std::string& name = each.topics.topic;
      const std::string& text = each.topics.text;
      if (each.topics.joints) {
        made.joints = add_topic(name + "/joints", joint_state_type(), messages, from, text);
      }
      if (each.topics.loads) {
        made.loads = add_topic(name + "/contacts", foot_loads_type(), messages, from, text);
      }
      made_.push_back(made);
    }
  }

 private:
  /// Ids of the topics that are made.
  struct Made {
    std::optional<std::uint32_t> joints, loads;
  };

  void restart() override {
    for (PartTopic& each : topics_) each.joiner = PartJoiner(each.topics.parts.size());
  }

  Result<void> see(const BagMessage& message) override {
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      if (!topics_[i].add(message)) continue;
      while (const auto set = topics_[i].joiner.next()) give_set(i, *set, message.record_time);
    }
    return {};
  }

  void give_set(std::size_t i, const JoinedParts& set, Time record_time) {
    const Parts& parts = topics_[i].topics.parts;
    // Contacts first: joints of the same message then find those of their instant.
    if (made_[i].loads) {
      std::vector<std::string> feet;
      std::vector<double> loads;
      for (std::size_t part = 0; part < parts.size(); ++part) {
        feet.push_back(parts[part].name);
        loads.push_back(set.silent[part] ? kUnknown : *set.samples[part]->load);
      }
      give(*made_[i].loads, record_time, loads_message(feet, loads, set.time));
    }
    if (made_[i].joints) give(*made_[i].joints, record_time, joints_message(parts, set));
  }

  std::vector<PartTopic> topics_;
  std::vector<Made> made_;  ///< of each
};

}  // namespace

void join_single_legs(std::unique_ptr<MessageSource>& source) {
  std::vector<PartTopic> topics;
  const std::vector<BagConnection>& all = source->connections();
  for (LegTopics& each : find_leg_topics(*source)) {
    std::map<std::uint32_t, MessageDecoder> decoders;
    std::optional<LegFields> fields;
    for (const BagConnection& connection : all) {
      const bool is_part = std::ranges::any_of(
          each.parts, [&](const LegPart& part) { return part.connection == connection.id; });
      if (!is_part) continue;
      auto decoder =
          MessageDecoder::create(connection.type, connection.definition, connection.format);
      if (!decoder) continue;
      if (!fields) fields.emplace(connection.type, *decoder);
      decoders.emplace(connection.id, std::move(*decoder));
    }
    if (!fields) continue;
    PartJoiner joiner(each.parts.size());
    topics.push_back({std::move(each), std::move(*fields), std::move(decoders), std::move(joiner)});
  }
  if (!topics.empty()) source = std::make_unique<JoinedLegs>(std::move(source), std::move(topics));
}

}  // namespace aims
