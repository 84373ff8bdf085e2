// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/recorded_legs.hpp"

#include <string>
#include <vector>

#include "core/files/yaml_config.hpp"
#include "recordings/topics/connection_decoders.hpp"
#include "recordings/topics/recording_topics.hpp"
#include "recordings/topics/topic_choice.hpp"

namespace aims {
namespace {

constexpr const char* kGroup = "robot.legs";  ///< of a scenario

}  // namespace

std::optional<LegGeometry> recorded_legs(MessageSource& recording) {
  const std::string topic(kScenarioTopic);
  if (type_of(recording.connections(), topic).empty()) return std::nullopt;
  recording.select({&topic, 1});
  recording.rewind();
  const auto message = recording.next();
  if (!message || !*message) return std::nullopt;
  ConnectionDecoders decoders;
  const auto view = decoders.decode(**message);
  const auto text = view ? view->text("data") : std::nullopt;
  if (!text) return std::nullopt;
  LegGeometry legs;
  const auto fields = [&legs] {
    Fields all;
    all.group(kGroup, legs);
    return all;
  };
  const auto read = load_group_text(*text, topic, kGroup, fields);
  return read && legs.thigh > 0.0 ? std::optional(legs) : std::nullopt;
}

}  // namespace aims
