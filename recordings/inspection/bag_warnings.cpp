// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/inspection/bag_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/text.hpp"
#include "recordings/source/recording_file.hpp"
#include "recordings/stream/too_short.hpp"
#include "recordings/topics/topic_choice.hpp"

namespace aims {
namespace {

constexpr double kMaxLoss = 0.01;              ///< [-]
constexpr double kMaxGapPeriods = 10.0;        ///< in periods of the topic
constexpr double kMinPause = 10.0;             ///< of all sensors [s]
constexpr double kPauseTolerance = 2.0;        ///< between their gaps [s]
constexpr double kMaxOffset = 0.5;             ///< between record time and stamp [s]
constexpr double kMaxOffsetDifference = 0.15;  ///< [s]
constexpr double kMaxClockOffset = 0.015;      ///< above what averaging over a sample causes [s]
constexpr double kMinStaticInterval = 2.0;     ///< [s]
constexpr double kLastSample = 0.1;            ///< an interval ends with its last sample [s]
constexpr double kGravity = 9.81;              ///< [m/s^2]
constexpr double kMaxForceError = 0.3;         ///< of a static accelerometer from gravity [m/s^2]
constexpr double kMinImuRate = 100.0;          ///< [Hz]
constexpr double kStandingClock = 5.0;         ///< messages with one stamp, as `hardly_advance`

/// The sensor whose delay concerns the topic.
std::string_view delay_of(const TopicInfo& topic) {
  if (is_cloud_type(topic.type)) return "lidar";
  return is_imu_type(topic.type) ? "imu" : "leg";
}

bool is_sensor(const TopicInfo& topic) {
  return topic.type.starts_with("sensor_msgs/") || is_cloud_type(topic.type) ||
         topic.type == "nav_msgs/Odometry" || topic.type == "geometry_msgs/TwistStamped";
}

/// The longest time in which no sensor has a stamp; nothing for a single sensor, and where their
/// longest gaps differ.
std::optional<double> common_gap(const BagInfo& info) {
  double shortest = std::numeric_limits<double>::max(), longest = 0.0;
  int sensors = 0;
  for (const TopicInfo& each : info.topics) {
    if (!is_sensor(each) || !each.largest_gap_s) continue;
    shortest = std::min(shortest, *each.largest_gap_s);
    longest = std::max(longest, *each.largest_gap_s);
    ++sensors;
  }
  const bool common = sensors > 1 && shortest > kMinPause && longest - shortest < kPauseTolerance;
  return common ? std::optional(shortest) : std::nullopt;
}

void warn_of_recorder(const BagInfo& info, std::vector<std::string>& out) {
  if (info.summary.repeated_messages > 0) {
    out.push_back(fmt::format("{} messages stand in two of the files: they count once",
                              info.summary.repeated_messages));
  }
  std::uint64_t unset = 0;
  double step = 0.0;
  for (const TopicInfo& each : info.topics) {
    unset += each.unset_record_times;
    step = std::max(step, each.recorder_step_s);
  }
  if (unset > 0) {
    out.push_back(
        fmt::format("{} messages are recorded at time 0, before the recorder's clock was "
                    "set; they are taken at their stamps",
                    unset));
  }
  if (const auto gap = common_gap(info)) {
    out.push_back(
        fmt::format("no sensor has stamps for {:.1f} s: the recording was paused, or all clocks "
                    "were set forward; what moved meanwhile is unknown to an estimate",
                    *gap));
  }
  if (step > 0.0) {
    out.push_back(
        fmt::format("the recorder's clock was set back by {:.3f} s while the sensors' "
                    "stamps ran on; messages are taken in the order of their stamps",
                    step));
  }
}

/// The IMU that is read, else the LiDAR. An offset of stamps from record times that sensors share
/// is the recorder's clock, which no delay of a sensor corrects.
const TopicInfo* reference_of(const BagInfo& info) {
  for (const std::string& topic : {info.used.imu, info.used.lidar}) {
    const TopicInfo* found = info.find(topic);
    if (found != nullptr && found->stamped && found->median_offset_s) return found;
  }
  return nullptr;
}

/// Whether reading says of a topic that its stamps are off, without the time that the sensor takes.
bool is_said(const BagInfo& info, const std::string& topic) {
  return info.stamp_faults.contains(topic);
}

/// Whether it says that the stamps of a topic do not serve at all.
bool is_unstamped(const BagInfo& info, const std::string& topic) {
  const auto fault = info.stamp_faults.find(topic);
  return fault != info.stamp_faults.end() && fault->second == StampFault::kUnusable;
}

/// Stamps whose clock is not that of the IMU, or without an IMU not the recorder's.
void warn_of_stamps(const BagInfo& info, const TopicInfo& topic, std::vector<std::string>& out) {
  if (!info.rates_text.empty()) return;  // no delay corrects it
  const TopicInfo* reference = reference_of(info);
  const bool said =
      is_said(info, topic.topic) || (reference != nullptr && is_said(info, reference->topic));
  if (!topic.stamped || said || !topic.median_offset_s) return;
  const double offset =
      *topic.median_offset_s - (reference != nullptr ? *reference->median_offset_s : 0.0);
  if (std::abs(offset) <= kMaxOffset) return;
  out.push_back(fmt::format(
      "{}: stamps are {:.3f} s {} {}; if the clocks differ, set recording.{}_delay={:.3f}",
      topic.topic, std::abs(offset), offset > 0.0 ? "before" : "after",
      reference != nullptr ? fmt::format("those of {}, by the record times", reference->topic)
                           : "the record times",
      delay_of(topic), -offset));
}

void warn_of_times(const BagInfo& info, const TopicInfo& topic, std::vector<std::string>& out) {
  if (!is_sensor(topic) || topic.messages < 2) return;
  if (topic.zero_stamps || topic.same_stamps) {
    out.push_back(
        fmt::format("{}: all stamps are {}; record times are used: set the stamps in the "
                    "driver",
                    topic.topic, topic.zero_stamps ? "zero" : "the same"));
  }
  const bool paused = common_gap(info).has_value();  // said once
  if (!paused && topic.loss.value_or(0.0) > kMaxLoss) {
    out.push_back(
        fmt::format("{}: about {:.1f} % of the messages are missing: check the robot's network, "
                    "record to a faster disk or with a larger buffer (rosbag record -b 0)",
                    topic.topic, 100.0 * *topic.loss));
  }
  if (!paused && topic.rate_hz && !topic.messages_per_stamp &&
      topic.largest_gap_s.value_or(0.0) * *topic.rate_hz > kMaxGapPeriods) {
    out.push_back(fmt::format("{}: a gap of {:.2f} s; estimators bridge it with the other sensors",
                              topic.topic, *topic.largest_gap_s));
  }
  if (topic.messages_per_stamp) {
    out.push_back(
        fmt::format("{}: comes in batches of about {:.0f} messages with one stamp: {:.1f} Hz, but "
                    "{:.1f} stamps "
                    "a second; {}: have the driver stamp each message",
                    topic.topic, *topic.messages_per_stamp, topic.rate_hz.value_or(0.0),
                    topic.rate_hz.value_or(0.0) / *topic.messages_per_stamp,
                    *topic.messages_per_stamp > kStandingClock ? "record times serve in their place"
                                                               : "one of each batch is used"));
  } else if (topic.repeated + topic.backwards > 0 && !is_unstamped(info, topic.topic)) {
    out.push_back(
        fmt::format("{}: {} stamps repeat and {} go backwards; such messages are dropped: fix the "
                    "driver's clock",
                    topic.topic, topic.repeated, topic.backwards));
  }
  warn_of_stamps(info, topic, out);
}

/// A different clock shows as a shift between the angular rates.
void warn_of_clock(const BagInfo& info, const TopicInfo& topic, std::vector<std::string>& out) {
  if (!info.rates_text.empty()) return;  // no delay corrects it
  // Of clocks that differ by more than the shifts that are tried, a gait has an alias among them.
  if (is_said(info, topic.topic) || is_said(info, info.used.imu)) return;
  if (!topic.clock || std::abs(topic.clock->seconds) < kMaxClockOffset) return;
  out.push_back(
      fmt::format("{}: angular rates are {:.1f} ms {} the IMU's (correlation {:.2f}); if it is the "
                  "legs' topic, set recording.leg_delay={:.4f}",
                  topic.topic, 1e3 * std::abs(topic.clock->seconds),
                  topic.clock->seconds > 0.0 ? "behind" : "ahead of", topic.clock->correlation,
                  topic.clock->seconds));
}

/// Sensors with different delays may use different clocks.
void warn_of_offsets(const BagInfo& info, std::vector<std::string>& out) {
  const TopicInfo* earliest = nullptr;
  const TopicInfo* latest = nullptr;
  for (const TopicInfo& each : info.topics) {
    if (!is_sensor(each) || !each.median_offset_s) continue;
    if (!earliest || *each.median_offset_s < *earliest->median_offset_s) earliest = &each;
    if (!latest || *each.median_offset_s > *latest->median_offset_s) latest = &each;
  }
  if (!earliest || *latest->median_offset_s - *earliest->median_offset_s < kMaxOffsetDifference)
    return;
  out.push_back(
      fmt::format("{} is recorded {} s after its stamps, {} {} s: their clocks "
                  "may differ; synchronise them, or set recording.*_delay",
                  latest->topic, decimal_text(*latest->median_offset_s, 3), earliest->topic,
                  decimal_text(*earliest->median_offset_s, 3)));
}

void warn_of_clouds(const CloudInfo& cloud, std::vector<std::string>& out) {
  if (cloud.broken > 0) {
    out.push_back(fmt::format("{}: {} of the first clouds cannot be read: {}", cloud.topic,
                              cloud.broken, cloud.first_broken));
  }
  if (cloud.clouds == 0) return;
  if (!cloud.repeated_text.empty()) out.push_back(cloud.repeated_text);
  if (!cloud.time_field()) {
    out.push_back(
        fmt::format("{}: points have no time; it is derived from their azimuth: enable it in the "
                    "driver, otherwise deskewing is approximate",
                    cloud.topic));
  }
  if (!cloud.ring_field() && cloud.height == 1) {
    out.push_back(
        fmt::format("{}: points have no ring; it is derived from their elevation", cloud.topic));
  }
  if (cloud.not_finite_fraction > 0.0 && cloud.dense) {
    out.push_back(
        fmt::format("{}: {:.1f} % of the points are NaN though is_dense is true; some "
                    "systems stop at that",
                    cloud.topic, 100.0 * cloud.not_finite_fraction));
  }
}

/// What is too short to tell anything.
std::optional<std::string> too_short(const BagInfo& info) {
  const TopicInfo* lidar = info.find(info.used.lidar);
  const double seconds = to_seconds(info.summary.end - info.summary.start);
  return too_short_text(lidar == nullptr ? std::nullopt : std::optional(lidar->messages), seconds);
}

void warn_of_imu(const BagInfo& info, const ImuInfo& imu, std::vector<std::string>& out) {
  if (imu.in_g) {
    out.push_back(fmt::format(
        "{}: the specific force is in g, not m/s^2; aims converts it, other systems may not",
        imu.topic));
  }
  const TopicInfo* topic = info.find(imu.topic);
  if (imu.new_rate_hz) {
    out.push_back(
        fmt::format("{}: each sample is sent several times, {:.0f} new ones come in a second: "
                    "other systems take the repetitions for samples",
                    imu.topic, *imu.new_rate_hz));
  }
  constexpr double kNominal = 0.95;  // of a rate that is meant
  if (topic && topic->rate_hz.value_or(kMinImuRate) < kNominal * kMinImuRate) {
    out.push_back(
        fmt::format("{}: {:.0f} Hz; footfalls alias into an IMU of this rate unless it averages, "
                    "and many systems require 100 Hz or more",
                    imu.topic, *topic->rate_hz));
  }
  const bool disordered = topic && topic->recorder_step_s > 0.0;  // the interval is cut
  const bool short_one = too_short(info).has_value();
  if (!disordered && !short_one &&
      (!imu.static_interval || imu.static_interval->begin_s > 1.0 ||
       imu.static_interval->length_s < kMinStaticInterval - kLastSample)) {
    out.push_back(
        fmt::format("{}: the robot is not static for {:.0f} s at the start; tilt and gyro bias are "
                    "then uncertain: let it stand before it walks",
                    imu.topic, kMinStaticInterval));
  }
  if (!imu.static_interval) return;
  if (std::abs(imu.static_interval->force.norm() - kGravity) > kMaxForceError) {
    out.push_back(
        fmt::format("{}: specific force of {:.3f} m/s^2 without motion; expected {:.2f}: calibrate "
                    "the accelerometer",
                    imu.topic, imu.static_interval->force.norm(), kGravity));
  }
}

/// A recording that was never closed or is damaged, with what repairs it.
void warn_of_damage(const BagInfo& info, std::vector<std::string>& out) {
  const BagSummary& summary = info.summary;
  if (summary.lost_messages > 0) {
    out.push_back(
        fmt::format("{} messages have impossible record times (2^63 ns or more) and are "
                    "left out",
                    summary.lost_messages));
  }
  if (summary.lost_packets >= kFewLostPackets) {
    out.push_back(
        fmt::format("{:.1f} % of the packets of the LiDAR are missing, by their azimuths: "
                    "check the network and the receive buffer of the recorder",
                    1e2 * summary.lost_packets));
  }
  if (summary.untimed_rows > 0) out.push_back(untimed_text(summary));
  if (summary.closed && summary.lost_bytes == 0) return;
  const auto known = format_by_content(info.file);
  const auto format = known ? known : format_by_name(info.file);
  std::string_view repair;
  if (format == RecordingFormat::kBag) repair = "; rosbag reindex makes it readable by other tools";
  if (format == RecordingFormat::kMcap)
    repair = "; `mcap recover` makes it readable by other tools";
  if (format == RecordingFormat::kRosbag2)
    repair = "; `ros2 bag reindex` makes it readable by others";
  out.push_back(
      fmt::format("the recording {}: {} bytes in damaged parts or behind the last intact "
                  "one are lost{}",
                  summary.closed ? "is damaged" : "was never closed", summary.lost_bytes, repair));
}

bool has_sensor_transform(const BagInfo& info) {
  return std::any_of(info.transforms.begin(), info.transforms.end(),
                     [](const TransformInfo& each) { return each.fixed; });
}

}  // namespace

std::vector<std::string> bag_warnings(const BagInfo& info) {
  std::vector<std::string> out;
  warn_of_damage(info, out);
  if (auto text = too_short(info)) out.push_back(std::move(*text));
  warn_of_recorder(info, out);
  if (info.undecodable > 0) {
    out.push_back(fmt::format("{} messages contradict their definition; the first: {}",
                              info.undecodable, info.first_undecodable));
  }
  for (const TopicInfo& each : info.topics) {
    warn_of_times(info, each, out);
    warn_of_clock(info, each, out);
  }
  if (info.rates_text.empty()) {
    warn_of_offsets(info, out);
  } else {
    out.push_back(info.rates_text);
  }
  for (const CloudInfo& each : info.clouds) warn_of_clouds(each, out);
  for (const ImuInfo& each : info.imus) warn_of_imu(info, each, out);
  if (!info.clouds.empty() && !has_sensor_transform(info) && !info.extrinsics_configured) {
    out.push_back(
        "no fixed transform on /tf_static: the pose of the LiDAR on the IMU is unknown; set "
        "recording.T_imu_lidar");
  }
  return out;
}

}  // namespace aims
