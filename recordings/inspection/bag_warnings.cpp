// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/inspection/bag_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "recordings/topics/topic_choice.hpp"

namespace aims {
namespace {

constexpr double kMuchLoss = 0.01;             ///< [-]
constexpr double kLongGapSamples = 10.0;       ///< in periods of the topic
constexpr double kOddOffset = 0.5;             ///< between record time and stamp [s]
constexpr double kOffsetBetweenTopics = 0.15;  ///< [s]
constexpr double kOddClock = 0.015;            ///< more than averaging over a sample explains [s]
constexpr double kShortRest = 2.0;             ///< [s]
constexpr double kGravity = 9.81;              ///< [m/s^2]
constexpr double kOddForce = 0.3;              ///< of a resting accelerometer from gravity [m/s^2]
constexpr double kSlowImu = 100.0;             ///< [Hz]

bool is_sensor(const TopicInfo& topic) {
  return topic.type.starts_with("sensor_msgs/") || is_cloud_type(topic.type) ||
         topic.type == "nav_msgs/Odometry" || topic.type == "geometry_msgs/TwistStamped";
}

void warn_of_times(const TopicInfo& topic, std::vector<std::string>& out) {
  if (!is_sensor(topic) || topic.messages < 2) return;
  if (topic.loss.value_or(0.0) > kMuchLoss) {
    out.push_back(
        fmt::format("{}: about {:.1f} % of the messages are missing, lost on the robot or while "
                    "recording: look at its "
                    "network, record on a faster disk or with a larger buffer (rosbag record -b 0)",
                    topic.topic, 100.0 * *topic.loss));
  }
  if (topic.rate_hz && topic.largest_gap_s.value_or(0.0) * *topic.rate_hz > kLongGapSamples) {
    out.push_back(
        fmt::format("{}: a gap of {:.2f} s; estimators coast through it on the other "
                    "sensors",
                    topic.topic, *topic.largest_gap_s));
  }
  if (topic.repeated + topic.backwards > 0) {
    out.push_back(
        fmt::format("{}: {} stamps repeat and {} go backwards; such messages are dropped: "
                    "mend the driver's clock",
                    topic.topic, topic.repeated, topic.backwards));
  }
  if (topic.stamped && std::abs(topic.median_offset_s.value_or(0.0)) > kOddOffset) {
    out.push_back(
        fmt::format("{}: stamps are {:.3f} s before the record times; if the clocks "
                    "differ, set the sensor's delay (recording.imu_delay, lidar_delay, "
                    "leg_delay)",
                    topic.topic, *topic.median_offset_s));
  }
}

/// A clock of its own shows in when the same turns are felt.
void warn_of_clock(const TopicInfo& topic, std::vector<std::string>& out) {
  if (!topic.clock || std::abs(topic.clock->seconds) < kOddClock) return;
  out.push_back(
      fmt::format("{}: feels turns {:.1f} ms {} the IMU (correlation {:.2f}); if it is the "
                  "legs' topic, recording.leg_delay={:.4f} makes it good",
                  topic.topic, 1e3 * std::abs(topic.clock->seconds),
                  topic.clock->seconds > 0.0 ? "after" : "before", topic.clock->correlation,
                  topic.clock->seconds));
}

/// Sensors that are late by different amounts may have clocks of their own.
void warn_of_offsets(const BagInfo& info, std::vector<std::string>& out) {
  const TopicInfo* least = nullptr;
  const TopicInfo* most = nullptr;
  for (const TopicInfo& each : info.topics) {
    if (!is_sensor(each) || !each.median_offset_s) continue;
    if (!least || *each.median_offset_s < *least->median_offset_s) least = &each;
    if (!most || *each.median_offset_s > *most->median_offset_s) most = &each;
  }
  if (!least || *most->median_offset_s - *least->median_offset_s < kOffsetBetweenTopics) return;
  out.push_back(
      fmt::format("{} is recorded {:.3f} s after its stamps, {} {:.3f} s: their clocks "
                  "may differ; synchronise them, or set recording.*_delay",
                  most->topic, *most->median_offset_s, least->topic, *least->median_offset_s));
}

void warn_of_clouds(const CloudInfo& cloud, std::vector<std::string>& out) {
  if (cloud.broken > 0) {
    out.push_back(fmt::format("{}: {} of the first clouds cannot be read: {}", cloud.topic,
                              cloud.broken, cloud.first_broken));
  }
  if (cloud.clouds == 0) return;
  if (!cloud.time_field()) {
    out.push_back(
        fmt::format("{}: points carry no time; it is made up from their azimuth: switch "
                    "it on in the driver, or the motion within a scan blurs",
                    cloud.topic));
  }
  if (!cloud.ring_field() && cloud.height == 1) {
    out.push_back(
        fmt::format("{}: points carry no ring; it is made up from their elevation", cloud.topic));
  }
  if (cloud.not_finite_share > 0.0 && cloud.dense) {
    out.push_back(
        fmt::format("{}: {:.1f} % of the points are NaN though is_dense is true; some "
                    "systems stop at that",
                    cloud.topic, 100.0 * cloud.not_finite_share));
  }
}

void warn_of_imu(const BagInfo& info, const ImuInfo& imu, std::vector<std::string>& out) {
  if (imu.in_g) {
    out.push_back(
        fmt::format("{}: the specific force is in g, not m/s^2; it is converted here, "
                    "other systems may not do so",
                    imu.topic));
  }
  const TopicInfo* topic = info.find(imu.topic);
  if (topic && topic->rate_hz.value_or(kSlowImu) < kSlowImu) {
    out.push_back(
        fmt::format("{}: {:.0f} Hz; footfalls alias into an IMU this slow unless it "
                    "averages, and many systems ask for 100 Hz or more",
                    imu.topic, *topic->rate_hz));
  }
  if (!imu.rest || imu.rest->begin_s > 1.0 || imu.rest->length_s < kShortRest) {
    out.push_back(
        fmt::format("{}: the robot does not stand still for {:.0f} s at the start; tilt "
                    "and gyro bias are then guessed: let it stand before it walks",
                    imu.topic, kShortRest));
  }
  if (!imu.rest) return;
  if (std::abs(imu.rest->force.norm() - kGravity) > kOddForce) {
    out.push_back(
        fmt::format("{}: at rest it reads {:.3f} m/s^2; expected {:.2f}: calibrate the "
                    "accelerometer",
                    imu.topic, imu.rest->force.norm(), kGravity));
  }
}

bool has_sensor_transform(const BagInfo& info) {
  return std::any_of(info.transforms.begin(), info.transforms.end(),
                     [](const TransformInfo& each) { return each.fixed; });
}

}  // namespace

std::vector<std::string> bag_warnings(const BagInfo& info) {
  std::vector<std::string> out;
  if (!info.summary.indexed || info.summary.lost_bytes > 0) {
    out.push_back(
        fmt::format("the bag was never closed: {} bytes behind the last whole chunk are "
                    "lost; rosbag reindex makes it readable elsewhere",
                    info.summary.lost_bytes));
  }
  if (info.undecodable > 0) {
    out.push_back(fmt::format("{} messages do not fit their definition; the first: {}",
                              info.undecodable, info.first_undecodable));
  }
  for (const TopicInfo& each : info.topics) {
    warn_of_times(each, out);
    warn_of_clock(each, out);
  }
  warn_of_offsets(info, out);
  for (const CloudInfo& each : info.clouds) warn_of_clouds(each, out);
  for (const ImuInfo& each : info.imus) warn_of_imu(info, each, out);
  if (!info.clouds.empty() && !has_sensor_transform(info)) {
    out.push_back(
        "no fixed transform on /tf_static: where the LiDAR sits on the IMU is unknown; "
        "give recording.T_imu_lidar");
  }
  return out;
}

}  // namespace aims
