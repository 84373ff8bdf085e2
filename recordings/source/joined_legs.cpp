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
#include "recordings/source/decided_start.hpp"
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

/// Where the feet are, FL, FR, RL, RR; in the frame that all name.
MessageBytes places_message(const JoinedParts& set) {
  MessageBytes out;
  out.put(std::uint32_t{0});
  out.time(set.time);
  const std::string& frame = set.samples.front()->frame;
  const bool same = std::ranges::all_of(
      set.samples, [&frame](const LegPartSample* each) { return each->frame == frame; });
  out.text(same ? frame : "");
  out.length(set.samples.size());
  for (std::size_t i = 0; i < set.samples.size(); ++i) {
    for (const double each : *set.samples[i]->place) out.put(set.silent[i] ? kUnknown : each);
  }
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

  /// Whether the message completes anything.
  bool add(const BagMessage& message) {
    const auto decoder = decoders.find(message.connection->id);
    if (decoder == decoders.end()) return false;
    const auto view = decoder->second.decode(message.data);
    if (!view) return false;
    bool added = false;
    for (auto& [part, sample] :
         samples_of(topics, fields, message.connection->id, *view, message.taken())) {
      const bool lacks = (topics.joints && sample.angles.empty()) ||
                         (topics.loads && !sample.load) || (topics.places && !sample.place);
      if (lacks || sample.time < 0) continue;
      joiner.add(part, std::move(sample));
      added = true;
    }
    return added;
  }
};

class JoinedLegs final : public DerivedSource {
 public:
  JoinedLegs(std::unique_ptr<MessageSource> source, std::vector<PartTopic> topics)
      : DerivedSource(std::move(source)), topics_(std::move(topics)) {
    for (PartTopic& each : topics_) {
      std::set<std::uint32_t> from;
      for (const LegPart& part : each.topics.parts) from.insert(part.connection);
      const std::uint64_t parts = each.topics.feet ? 1 : each.topics.parts.size();
      const std::uint64_t messages = mark_parts(from) / parts;
      Made made;
      const std::string& name = each.topics.topic;
      const std::string& text = each.topics.text;
      if (each.topics.joints) {
        made.joints = add_topic(name + "/joints", joint_state_type(), messages, from, text);
      }
      if (each.topics.loads) {
        made.loads = add_topic(name + "/contacts", foot_loads_type(), messages, from, text);
      }
      if (each.topics.places) {
        made.places = add_topic(name + "/feet", foot_places_type(), messages, from, text);
      }
      made_.push_back(made);
    }
  }

 private:
  /// Ids of the topics that are made.
  struct Made {
    std::optional<std::uint32_t> joints, loads, places;
  };

  void restart() override {
    for (PartTopic& each : topics_) {
      each.joiner = PartJoiner(each.topics.parts.size(), each.topics.on_change);
    }
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
    if (made_[i].places) give(*made_[i].places, record_time, places_message(set));
  }

  std::vector<PartTopic> topics_;
  std::vector<Made> made_;  ///< of each
};

}  // namespace

void join_single_legs(std::unique_ptr<MessageSource>& source) {
  std::vector<PartTopic> topics;
  const std::vector<BagConnection>& all = source->connections();
  // A live estimate decided from what it had heard.
  DecidedStart start(*source);
  for (LegTopics& each : find_leg_topics(is_of_live_estimate(*source) ? start : *source)) {
    std::map<std::uint32_t, MessageDecoder> decoders;
    std::optional<LegFields> fields;
    for (const BagConnection& connection : all) {
      const bool is_part = std::ranges::any_of(
          each.parts, [&](const LegPart& part) { return part.connection == connection.id; });
      if (!is_part) continue;
      auto decoder =
          MessageDecoder::create(connection.type, connection.definition, connection.format);
      if (!decoder) continue;
      if (!fields) fields.emplace(connection.topic, connection.type, *decoder);
      decoders.emplace(connection.id, std::move(*decoder));
    }
    if (!fields) continue;
    PartJoiner joiner(each.parts.size(), each.on_change);
    topics.push_back({std::move(each), std::move(*fields), std::move(decoders), std::move(joiner)});
  }
  if (!topics.empty()) source = std::make_unique<JoinedLegs>(std::move(source), std::move(topics));
}

}  // namespace aims
