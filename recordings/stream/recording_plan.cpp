// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/recording_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "core/files/yaml_config.hpp"
#include "core/leg_geometry.hpp"
#include "recordings/frames/configured_extrinsic.hpp"
#include "recordings/messages/message_types.hpp"
#include "recordings/source/recording_file.hpp"
#include "recordings/stream/recording_survey.hpp"
#include "recordings/stream/single_legs.hpp"
#include "recordings/topics/connection_decoders.hpp"
#include "recordings/topics/recording_topics.hpp"
#include "recordings/topics/topic_choice.hpp"

namespace aims {
namespace {

// The survey of a topic ends at the first of these limits.
constexpr Duration kSurveySpan = 10 * kSecond;
constexpr Duration kMaxSurveyStep = kSecond;  ///< a longer gap in the record times counts as this
constexpr std::size_t kSurveyMessages = 50'000;
constexpr std::size_t kSurveyBytes = std::size_t{512} << 20;
constexpr std::size_t kTransformMessages = 2000;
constexpr std::size_t kFixedTransformMessages = 100;
constexpr std::size_t kLoadMessages = 500'000;  ///< 1000 s of a Unitree robot

/// How far record times have gone; one that is far off, as of an unset clock, hardly counts.
class Elapsed {
 public:
  Duration add(Time record_time) {
    if (last_) passed_ += std::clamp<Duration>(record_time - *last_, 0, kMaxSurveyStep);
    last_ = record_time;
    return passed_;
  }

 private:
  std::optional<Time> last_;
  Duration passed_ = 0;
};

/// The legs of the robot, as the scenario in a simulated recording states them; nothing where no
/// scenario does. Rewinds the recording.
std::optional<LegGeometry> recorded_legs(MessageSource& recording) {
  constexpr const char* kGroup = "robot.legs";  // of a scenario
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

/// Reads the first messages of one tf topic.
Result<void> survey_transforms(MessageSource& bag, const std::string& topic, bool fixed,
                               RecordingSurvey& survey) {
  if (type_of(bag.connections(), topic).empty()) return {};
  ConnectionDecoders decoders;
  bag.select(std::vector<std::string>{topic});
  bag.rewind();
  Elapsed elapsed;
  for (std::size_t i = 0; i < kTransformMessages; ++i) {
    const auto message = bag.next();
    if (!message) return tl::unexpected(message.error());
    if (!*message) break;
    // Fixed transforms may be published late; of the others the first ones are used.
    const Duration past = elapsed.add((*message)->record_time);
    if (fixed ? i >= kFixedTransformMessages : past > kSurveySpan) break;
    const auto view = decoders.decode(**message);
    if (view) survey.add_transforms(*view, fixed);
  }
  return {};
}

/// The topic of transforms; of a robot with a namespace, the only one that ends so.
std::string transforms_topic(const MessageSource& bag, const std::string& name,
                             std::vector<std::string>& notes) {
  if (!type_of(bag.connections(), name).empty()) return name;
  std::set<std::string> found;
  for (const BagConnection& each : bag.connections()) {
    if (each.topic.ends_with(name) && each.type.starts_with("tf")) found.insert(each.topic);
  }
  if (found.size() != 1) return name;
  notes.push_back(fmt::format("{}: taken for {}", *found.begin(), name));
  return *found.begin();
}

/// Reads the first messages of one topic, whenever they come.
Result<void> survey_topic(MessageSource& bag, const std::string& topic,
                          const RecordingChannels& channels, RecordingSurvey& survey) {
  bag.select(std::vector<std::string>{topic});
  bag.rewind();
  Elapsed elapsed;
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < kSurveyMessages && bytes < kSurveyBytes; ++i) {
    const auto message = bag.next();
    if (!message) {
      // The messages before it may suffice; the reader reports the error when it gets there.
      if (i > 0) return {};
      return tl::unexpected(message.error());
    }
    if (!*message || survey.enough(topic)) break;
    if (elapsed.add((*message)->record_time) > kSurveySpan) break;
    bytes += (*message)->data.size();
    if (const Channel* channel = channels.find(**message)) survey.add(**message, *channel);
  }
  return {};
}

/// Reads how the legs move, over the whole recording: a robot may stand at its start.
void survey_motion(MessageSource& bag, const TopicsConfig& topics,
                   const RecordingChannels& channels, RecordingSurvey& survey) {
  bag.select(std::vector<std::string>{topics.joint_states, topics.contacts, topics.imu});
  bag.rewind();
  for (std::size_t i = 0; i < 3 * kLoadMessages && survey.needs_motion(); ++i) {
    const auto message = bag.next();
    // The reader reports an error when it gets there.
    if (!message || !*message) return;
    if (const Channel* channel = channels.find(**message)) survey.add_motion(**message, *channel);
  }
}

/// Reads the loads of the feet of the whole recording: a robot may stand at its start.
void survey_loads(MessageSource& bag, const std::string& topic, RecordingSurvey& survey) {
  ConnectionDecoders decoders;
  bag.select(std::vector<std::string>{topic});
  bag.rewind();
  for (std::size_t i = 0; i < kLoadMessages; ++i) {
    const auto message = bag.next();
    // The reader reports an error when it gets there.
    if (!message || !*message) return;
    const auto view = decoders.decode(**message);
    if (view) survey.add_loads(*view);
  }
}

/// The legs of the robot whose message type has the joints, if it has one.
const StateLayout* state_of_joints(const RecordingChannels& channels, const TopicsConfig& topics) {
  const Channel* joints = channels.of_topic(topics.joint_states);
  return joints != nullptr && joints->state != nullptr && joints->state->geometry != nullptr
             ? joints->state
             : nullptr;
}

/// Lengths where nothing states any: of a Unitree Go1, whose size the simulated robot has.
constexpr LegGeometry kAssumedLegs = {0.188, 0.047, 0.08, 0.213, 0.213, 0.022};

/// `given` with its zeros from `others`, which are those of `whose`; a note where only some are.
LegGeometry completed(LegGeometry given, const LegGeometry& others, std::string_view whose,
                      std::vector<std::string>& notes) {
  constexpr std::pair<const char*, double LegGeometry::*> kLengths[] = {
      {"hip_x", &LegGeometry::hip_x},         {"hip_y", &LegGeometry::hip_y},
      {"abduction", &LegGeometry::abduction}, {"thigh", &LegGeometry::thigh},
      {"calf", &LegGeometry::calf},           {"foot_radius", &LegGeometry::foot_radius}};
  const bool states_some = given != LegGeometry();
  std::vector<std::string> taken;
  for (const auto& [name, length] : kLengths) {
    if (given.*length != 0.0) continue;
    given.*length = others.*length;
    taken.push_back(fmt::format("{} {} m", name, others.*length));
  }
  if (states_some && !taken.empty()) {
    notes.push_back(
        fmt::format("leg geometry: {} of {}, since leg_geometry does not state them (or as 0)",
                    fmt::join(taken, ", "), whose));
  }
  return given;
}

/// The configuration with all lengths of the legs; `known`: something states some.
struct WithLegs {
  RecordingConfig config;
  bool known = true;
};

WithLegs with_legs(const RecordingConfig& given, MessageSource& bag, const StateLayout* state,
                   std::vector<std::string>& notes) {
  const bool states_some = given.leg_geometry != LegGeometry();
  WithLegs with{given};
  LegGeometry& legs = with.config.leg_geometry;
  if (const auto recorded = recorded_legs(bag)) {
    legs = completed(given.leg_geometry, *recorded, "the recording's scenario", notes);
    if (!states_some && legs != kAssumedLegs) {
      notes.push_back("leg geometry: as the recording's scenario states it (robot.legs)");
    }
  } else if (state != nullptr) {
    legs = completed(given.leg_geometry, *state->geometry, state->robot, notes);
    if (states_some) return with;
    notes.push_back(
        fmt::format("leg geometry: that of {}, as the message type {} suggests (leg_geometry)",
                    state->robot, state->type));
  } else {
    legs = completed(given.leg_geometry, kAssumedLegs, "a Unitree Go1", notes);
    with.known = states_some;
  }
  return with;
}

/// Of legs whose lengths nothing states.
void warn_of_legs(RecordingSetup& setup) {
  setup.warnings.push_back(
      {"lengths of the legs assumed",
       fmt::format("nothing states the lengths of the legs: those of a Unitree Go1 are assumed "
                   "(thigh {0} m); distances by the legs are wrong in proportion to their error. "
                   "Set recording.leg_geometry (of a Go1: {{thigh: {0}}})",
                   kAssumedLegs.thigh),
       WarnedSensor::kLegs});
}

/// Of samples that were recorded in batches.
void warn_of_batches(MessageSource& bag, RecordingSetup& setup) {
  constexpr std::size_t kMostNamed = 4;
  const TopicsConfig& topics = setup.topics;
  std::map<bool, std::vector<std::string>> found;  // of the IMU and of the legs
  std::map<bool, double> samples;
  for (const BagConnection& each : bag.connections()) {
    const auto is_of = [&each](const std::string& topic) { return topic == each.topic; };
    const bool legs = is_of(topics.leg_odometry) || is_of(topics.joint_states) ||
                      is_of(topics.contacts) || each.is_part;
    const bool imu = is_of(topics.imu) || topics.imu == each.topic + "/imu";
    if (each.batch == 0.0 || (!legs && !imu)) continue;
    found[imu].push_back(each.topic);
    samples[imu] = std::max(samples[imu], each.batch);
  }
  for (auto& [imu, names] : found) {
    const std::size_t all = names.size();
    names.resize(std::min(all, kMostNamed));
    const std::string more =
        all > names.size() ? fmt::format(" and {} more", all - names.size()) : "";
    setup.warnings.push_back(
        {fmt::format("times of the {} spread over batches", imu ? "IMU" : "legs"),
         fmt::format("{}{}: no stamps, and record times come in batches of {:.3g} samples: they "
                     "are spread evenly over the time since the batch before; set the stamps in "
                     "the driver",
                     fmt::join(names, ", "), more, samples[imu]),
         imu ? WarnedSensor::kAny : WarnedSensor::kLegs});
  }
}

/// Of topics that are joined of others.
void note_joined(MessageSource& bag, RecordingSetup& setup) {
  for (const BagConnection& each : bag.connections()) {
    if (each.joined_from.empty()) continue;
    const TopicsConfig& topics = setup.topics;
    const auto used = {topics.joint_states, topics.contacts, topics.leg_odometry, topics.imu};
    if (std::ranges::find(used, each.topic) == used.end()) continue;
    setup.notes.push_back(fmt::format("{}: joined from {}", each.topic, each.joined_from));
  }
}

/// Of legs that are recorded, each in messages of its own.
void warn_of_single_legs(MessageSource& bag, RecordingSetup& setup) {
  if (setup.has_legs) return;
  const std::string text = single_legs_text(bag.connections());
  if (text.empty()) return;
  setup.leg_lack = text;
  setup.contacts_unknown = false;
  setup.warnings.push_back({"legs in messages of their own", text, WarnedSensor::kLegs});
}

/// Of packets of the LiDAR that the capture lacks.
void warn_of_packets(const BagSummary& summary, std::vector<ReadingWarning>& warnings) {
  if (summary.lost_packets < kFewLostPackets) return;
  warnings.push_back({"packets of the LiDAR are missing",
                      fmt::format("{:.1f} % of the packets of the LiDAR are missing, by their "
                                  "azimuths: its scans have holes",
                                  1e2 * summary.lost_packets),
                      WarnedSensor::kLidar});
}

/// Of rows of a table that are left out.
void warn_of_rows(const BagSummary& summary, std::vector<ReadingWarning>& warnings) {
  if (summary.untimed_rows == 0) return;
  warnings.push_back({"rows of the table have no time", untimed_text(summary)});
}

/// Of files whose recorders had different clocks.
void warn_of_recorders(const BagSummary& summary, std::vector<ReadingWarning>& warnings) {
  if (summary.clock_shift == 0) return;
  warnings.push_back(
      {"clocks of the recorders differ",
       fmt::format("the stamps of the files agree, but record times of one are {:.3f} s {} by "
                   "another recorder's clock: its messages are merged by their stamps",
                   std::abs(to_seconds(summary.clock_shift)),
                   summary.clock_shift < 0 ? "ahead" : "behind"),
       WarnedSensor::kAny, WarningKind::kClocks});
}

}  // namespace

Result<RecordingPlan> plan_recording(MessageSource& bag, const RecordingConfig& given,
                                     const TopicsConfig& topics, const RecordingChannels& channels,
                                     std::vector<std::string> notes) {
  const auto plain = with_plain_extrinsics(given);
  if (!plain) return tl::unexpected(plain.error());
  const auto [config, legs_are_known] =
      with_legs(*plain, bag, state_of_joints(channels, topics), notes);
  if (bag.summary().recorded_at_stamps) {
    notes.push_back("record times are all the same: messages arrive in the order of the file");
  }
  RecordingSurvey survey(config, topics);
  for (const auto& [topic, fixed] : {std::pair("/tf_static", true), std::pair("/tf", false)}) {
    const std::string found = transforms_topic(bag, topic, notes);
    if (auto ok = survey_transforms(bag, found, fixed, survey); !ok) {
      return tl::unexpected(ok.error());
    }
  }
  for (const std::string& topic : channels.topics()) {
    const auto ok = survey_topic(bag, topic, channels, survey);
    if (!ok) return tl::unexpected(ok.error());
  }
  if (survey.needs_motion()) survey_motion(bag, topics, channels, survey);
  if (survey.learns_contacts()) survey_loads(bag, topics.contacts, survey);
  auto plan = survey.decide(bag.name(), std::move(notes));
  if (!plan) return plan;
  plan->start = survey.start(bag.summary());
  plan->record_rate = survey.record_rate();
  warn_of_recorders(bag.summary(), plan->setup.warnings);
  warn_of_packets(bag.summary(), plan->setup.warnings);
  warn_of_rows(bag.summary(), plan->setup.warnings);
  warn_of_batches(bag, plan->setup);
  note_joined(bag, plan->setup);
  warn_of_single_legs(bag, plan->setup);
  if (plan->setup.has_joints && !legs_are_known) warn_of_legs(plan->setup);
  return plan;
}

}  // namespace aims
