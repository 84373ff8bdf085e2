// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/recording_plan.hpp"

#include <map>
#include <optional>
#include <utility>

#include "recordings/stream/recording_survey.hpp"

namespace aims {
namespace {

// The survey ends with the first of these.
constexpr Duration kSurveySpan = 10 * kSecond;
constexpr Duration kLongestSurveySpan = 60 * kSecond;  ///< while a topic has not been met
constexpr std::size_t kSurveyMessages = 50'000;
constexpr std::size_t kSurveyBytes = std::size_t{512} << 20;
constexpr std::size_t kTransformMessages = 2000;
constexpr std::size_t kFixedTransformMessages = 100;

/// Reads the first messages of tf alone; chunks without them are not read.
Result<void> survey_transforms(MessageSource& bag, const std::string& topic, bool fixed,
                               RecordingSurvey& survey) {
  std::map<std::uint32_t, MessageDecoder> decoders;
  for (const BagConnection& connection : bag.connections()) {
    if (connection.topic != topic) continue;
    auto decoder = MessageDecoder::create(connection.type, connection.definition);
    if (decoder) decoders.emplace(connection.id, std::move(*decoder));
  }
  if (decoders.empty()) return {};
  bag.select(std::vector<std::string>{topic});
  bag.rewind();
  for (std::size_t i = 0; i < kTransformMessages; ++i) {
    const auto message = bag.next();
    if (!message) return tl::unexpected(message.error());
    if (!*message) break;
    // Fixed ones may be told late; the others are wanted as they are at the start.
    const Duration past = (*message)->record_time - bag.summary().start;
    if (fixed ? i >= kFixedTransformMessages : past > kSurveySpan) break;
    const auto decoder = decoders.find((*message)->connection->id);
    if (decoder == decoders.end()) continue;
    const auto view = decoder->second.decode((*message)->data);
    if (view) survey.add_transforms(*view, fixed);
  }
  return {};
}

Result<void> survey_sensors(MessageSource& bag, const RecordingChannels& channels,
                            RecordingSurvey& survey) {
  bag.select(channels.topics());
  bag.rewind();
  std::optional<Time> start;
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < kSurveyMessages && bytes < kSurveyBytes; ++i) {
    const auto message = bag.next();
    if (!message) {
      // What came before may do; the stream will meet the error where it is.
      if (start) return {};
      return tl::unexpected(message.error());
    }
    if (!*message) break;
    if (!start) start = (*message)->record_time;
    const Duration past = (*message)->record_time - *start;
    if (survey.enough() || past > kLongestSurveySpan) break;
    if (past > kSurveySpan && survey.met_all()) break;
    bytes += (*message)->data.size();
    if (const Channel* channel = channels.find(**message)) survey.add(**message, *channel);
  }
  return {};
}

}  // namespace

Result<RecordingPlan> plan_recording(MessageSource& bag, const RecordingConfig& config,
                                     const TopicsConfig& topics, const RecordingChannels& channels,
                                     std::vector<std::string> notes) {
  RecordingSurvey survey(config, topics);
  if (auto ok = survey_transforms(bag, "/tf_static", true, survey); !ok) {
    return tl::unexpected(ok.error());
  }
  if (auto ok = survey_transforms(bag, "/tf", false, survey); !ok) {
    return tl::unexpected(ok.error());
  }
  if (auto ok = survey_sensors(bag, channels, survey); !ok) return tl::unexpected(ok.error());
  return survey.decide(bag.name(), std::move(notes));
}

}  // namespace aims
