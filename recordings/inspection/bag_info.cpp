// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/inspection/bag_info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "recordings/clouds/cloud_survey.hpp"
#include "recordings/inspection/bag_warnings.hpp"
#include "recordings/inspection/sensor_inspection.hpp"
#include "recordings/inspection/topic_statistics.hpp"
#include "recordings/messages/message_values.hpp"
#include "recordings/source/recording_file.hpp"
#include "recordings/stream/latency_changes.hpp"
#include "recordings/stream/record_clock.hpp"
#include "recordings/stream/recording_reader.hpp"
#include "recordings/stream/stream_warnings.hpp"
#include "recordings/topics/connection_decoders.hpp"
#include "recordings/topics/topic_choice.hpp"

namespace aims {
namespace {

constexpr std::size_t kMaxTransforms = 256;
constexpr std::size_t kMaxTurnRates = 100'000;

/// Accumulates the info, message by message.
class Survey {
 public:
  void add(const BagMessage& message, BagInfo& info) {
    const BagConnection& connection = *message.connection;
    TopicStatistics& times = statistics_[connection.topic];
    const auto view = decode(message, info);
    std::optional<Time> stamp = view ? view->time("header.stamp") : std::nullopt;
    times.add(message.record_time, stamp);
    if (stamp.value_or(0) != 0) {
      trends_[connection.topic].add(message.record_time, message.record_time - *stamp);
    }
    if (message.record_time > kSetRecordTime)
      first_set_ = std::min(first_set_, message.record_time);
    if (stamp) stamp = advancing(connection.topic, *stamp, message.record_time);
    if (!view) return;
    if (!frames_.contains(connection.topic)) {
      frames_[connection.topic] = std::string(view->text("header.frame_id").value_or(""));
    }
    if (is_cloud_type(connection.type)) {
      clouds_.try_emplace(connection.topic, connection.topic)
          .first->second.add(*view, stamp.value_or(message.record_time));
    } else if (is_imu_type(connection.type)) {
      imus_.try_emplace(connection.topic, connection.topic)
          .first->second.add(*view, stamp.value_or(message.record_time));
      add_turn_rate(connection.topic, *view, "angular_velocity", stamp);
    } else if (connection.type == "nav_msgs/Odometry") {
      add_turn_rate(connection.topic, *view, "twist.twist.angular", stamp);
    } else if (connection.type == "geometry_msgs/TwistStamped") {
      add_turn_rate(connection.topic, *view, "twist.angular", stamp);
    } else if (connection.type == "tf2_msgs/TFMessage" || connection.type == "tf/tfMessage") {
      add_transforms(*view, connection.topic == "/tf_static", info);
    }
  }

  void finish(const std::vector<BagConnection>& connections, BagInfo& info) {
    const bool unset = info.summary.start < kSetRecordTime;
    if (unset && info.summary.end > kSetRecordTime) info.summary.start = first_set_;
    std::map<std::string, std::string> types;
    for (const BagConnection& each : connections) types[each.topic] = each.type;
    for (const auto& [topic, type] : types) {
      TopicInfo& added = info.topics.emplace_back();
      added.topic = topic;
      added.type = type;
      added.frame = frames_[topic];
      statistics_[topic].finish(added);
    }
    compare_clocks(info);
    for (auto& [topic, survey] : clouds_) info.clouds.push_back(survey.finish());
    for (auto& [topic, survey] : imus_) info.imus.push_back(survey.finish());
  }

  /// Finds clocks of sensors that are read and run at another rate than that of the IMU.
  void compare_rates(BagInfo& info) const {
    const std::string& imu = info.used.imu;
    if (!has_clock(info, imu)) return;
    for (const auto& topic : {info.used.lidar, info.used.leg_odometry, info.used.joint_states}) {
      if (topic == imu || !has_clock(info, topic)) continue;
      const auto growth = trends_.at(imu).growth(trends_.at(topic));
      if (!growth) continue;
      info.rates_text = warning_of_rates(imu, topic, *growth).text;
      return;
    }
  }

 private:
  /// The stamp; the time by the recorder where it was never set, or is still that of the first
  /// message.
  Time advancing(const std::string& topic, Time stamp, Time recorded) {
    if (stamp == 0) return recorded;
    const auto first = first_stamps_.try_emplace(topic, stamp, recorded).first;
    const auto& [first_stamp, first_recorded] = first->second;
    return stamp == first_stamp ? stamp + (recorded - first_recorded) : stamp;
  }

  /// Whether the stamps of a topic advance from message to message.
  bool has_clock(const BagInfo& info, const std::string& topic) const {
    const TopicInfo* found = info.find(topic);
    return found != nullptr && trends_.contains(topic) && found->stamped &&
           !found->messages_per_stamp;
  }

  void add_turn_rate(const std::string& topic, const MessageView& message, const char* path,
                     std::optional<Time> stamp) {
    const auto rate = vector_at(message, path);
    std::vector<TurnRate>& rates = turns_[topic];
    if (!rate || !rate->allFinite() || !stamp || rates.size() == kMaxTurnRates) return;
    if (rates.empty() || rates.back().stamp < *stamp) rates.push_back({*stamp, rate->norm()});
  }

  /// Estimates the clock offset of every sensor with angular rates relative to the fastest IMU.
  void compare_clocks(BagInfo& info) const {
    if (imus_.empty()) return;
    const auto fewer = [this](const auto& a, const auto& b) {
      return turns_.at(a.first).size() < turns_.at(b.first).size();
    };
    const std::string& reference = std::max_element(imus_.begin(), imus_.end(), fewer)->first;
    for (TopicInfo& each : info.topics) {
      const auto rates = turns_.find(each.topic);
      if (rates == turns_.end() || each.topic == reference) continue;
      each.clock = clock_offset(rates->second, turns_.at(reference));
    }
  }

  std::optional<MessageView> decode(const BagMessage& message, BagInfo& info) {
    const BagConnection& connection = *message.connection;
    const bool cdr = connection.format.serialization == Serialization::kCdr;
    if (cdr && connection.definition.empty())
      return info.undefined.insert(connection.type), std::nullopt;
    auto view = decoders_.decode(message);
    if (view) return std::move(*view);
    if (info.undecodable++ == 0) {
      info.first_undecodable =
          fmt::format("{} in the chunk at offset {}: {}", message.connection->topic, message.offset,
                      view.error().message);
    }
    return std::nullopt;
  }

  static void add_transforms(const MessageView& message, bool fixed, BagInfo& info) {
    for (const FrameTransform& each : transforms_in(message)) {
      const bool known = std::any_of(
          info.transforms.begin(), info.transforms.end(), [&each](const TransformInfo& other) {
            return other.parent == each.parent && other.child == each.child;
          });
      if (known || info.transforms.size() >= kMaxTransforms) continue;
      info.transforms.push_back(
          {std::string(each.parent), std::string(each.child), each.T_parent_child, fixed});
    }
  }

  Time first_set_ = std::numeric_limits<Time>::max();  ///< record time of a set clock
  ConnectionDecoders decoders_;
  std::map<std::string, TopicStatistics> statistics_;
  std::map<std::string, LatencyTrend> trends_;
  std::map<std::string, std::pair<Time, Time>> first_stamps_;  ///< and their record times
  std::map<std::string, std::string> frames_;
  std::map<std::string, CloudInspection> clouds_;
  std::map<std::string, ImuInspection> imus_;
  std::map<std::string, std::vector<TurnRate>> turns_;  ///< angular rates by topic
};

}  // namespace

const PointFieldInfo* CloudInfo::find(const std::string& name) const {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [&name](const auto& each) { return each.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

const PointFieldInfo* CloudInfo::time_field() const { return find_any(time_field_names()); }
const PointFieldInfo* CloudInfo::ring_field() const { return find_any(ring_field_names()); }

const PointFieldInfo* CloudInfo::find_any(std::span<const std::string_view> names) const {
  for (const std::string_view name : names) {
    if (const PointFieldInfo* field = find(std::string(name))) return field;
  }
  return nullptr;
}

const TopicInfo* BagInfo::find(const std::string& topic) const {
  const auto found = std::find_if(topics.begin(), topics.end(),
                                  [&topic](const auto& each) { return each.topic == topic; });
  return found == topics.end() ? nullptr : &*found;
}

namespace {

bool opens_without_lidar(const std::filesystem::path& bag, RecordingConfig config,
                         const BagOpenOptions& options) {
  config.topics.lidar = "none";
  return RecordingReader::open(bag, config, options).has_value();
}

}  // namespace

Result<BagInfo> bag_info(const std::filesystem::path& bag, const RecordingConfig& config,
                         BagOpenOptions options) {
  auto opened = open_sensor_recording(bag, options, true);
  if (!opened) return tl::unexpected(opened.error());
  const std::unique_ptr<MessageSource>& reader = *opened;
  BagInfo info;
  info.file = options.with.empty() ? bag : std::filesystem::path(reader->name());
  info.summary = reader->summary();
  Survey survey;
  while (true) {
    auto message = reader->next();
    if (!message) return tl::unexpected(message.error());
    if (!*message) break;
    survey.add(**message, info);
  }
  info.summary.repeated_messages = reader->summary().repeated_messages;
  survey.finish(reader->connections(), info);
  const auto recording = RecordingReader::open(bag, config, options);
  if (recording) {
    info.used = recording->setup().topics;
    if (!recording->setup().has_legs) info.leg_lack = recording->setup().leg_lack;
    info.notes = recording->setup().notes;
    info.stamp_faults = recording->setup().stamp_faults;
    for (const ReadingWarning& each : recording->setup().warnings) {
      info.notes.push_back(each.text);
      if (each.kind == WarningKind::kPointTimes) info.times_text = each.text;
    }
    if (config.point_time_unit == PointTimeUnit::kNone) {
      info.times_text =
          "its times are not used (recording.point_time_unit=none): azimuths serve in their place";
    }
  } else {
    info.refusal = recording.error().message;
    info.opens_without_lidar = info.clouds.empty() && opens_without_lidar(bag, config, options);
    info.used = unambiguous_topics(info.file, reader->connections(), config.topics);
  }
  for (const std::string& type : info.undefined) {
    info.notes.push_back(
        fmt::format("{}: the recording has no definition of this type: not decoded", type));
  }
  survey.compare_rates(info);
  for (CloudInfo& each : info.clouds) {
    if (each.topic != info.used.lidar) each.repeated_text.clear();  // a map may be sent again
  }
  info.extrinsics_configured = config.T_imu_lidar.is_given();
  info.warnings = bag_warnings(info);
  return info;
}

}  // namespace aims
