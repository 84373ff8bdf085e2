// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/measurements.hpp"
#include "recordings/bag/message_source.hpp"
#include "recordings/source/feet_messages.hpp"
#include "recordings/source/leg_fields.hpp"

namespace aims {

/// A leg, or a joint of one, that has messages of its own.
struct LegPart {
  std::uint32_t connection = 0;
  std::string name;          ///< of the leg: "FL", or what is known of it: "leg2"
  std::string recorded;      ///< the same, by names alone
  std::optional<int> leg;    ///< nothing: the name tells no place
  std::size_t number = 0;    ///< of the leg, 0 to 3
  std::optional<int> joint;  ///< of a single joint: 0 abduction, 1 hip, 2 knee
  std::size_t entry = 0;     ///< of arrays with all feet
};

/// All legs of a robot in messages of one type.
struct LegTopics {
  std::string topic;                                   ///< their name without that of the leg
  std::vector<LegPart> parts;                          ///< leg by leg
  bool joints = false, loads = false, places = false;  ///< what they hold
  std::optional<FeetPaths> feet;                       ///< of messages that hold all four
  bool on_change = false;  ///< loads that are published only when they change
  std::string text;        ///< their topics, in words
};

/// Whether a topic may be of joints or feet, by its type and name.
bool may_be_of_legs(const BagConnection& connection);

/// The samples of a message of that connection, each with the number of its part. `time`: without a
/// stamp.
std::vector<std::pair<std::size_t, LegPartSample>> samples_of(const LegTopics& topics,
                                                              const LegFields& fields,
                                                              std::uint32_t connection,
                                                              const MessageView& message,
                                                              Time time);

/// What of a recording is published leg by leg, on a topic each or each in a message that says
/// which one it is, of all four legs. Reads the first messages of topics that may be so; rewinds.
std::vector<LegTopics> find_leg_topics(MessageSource& source);

}  // namespace aims
