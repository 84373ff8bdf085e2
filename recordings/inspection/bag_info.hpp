// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/lie.hpp"
#include "recordings/bag/chunk_reader.hpp"
#include "recordings/inspection/clock_offset.hpp"
#include "recordings/reading_notes.hpp"
#include "recordings/recording_config.hpp"

namespace aims {

/// Timing of the messages of one topic.
struct TopicInfo {
  std::string topic;
  std::string type;
  std::string frame;  ///< of the first header; empty: no header
  std::uint64_t messages = 0;
  bool stamped = false;                  ///< the messages have stamps, not all zero or the same
  bool zero_stamps = false;              ///< all stamps are zero: record times serve
  bool same_stamps = false;              ///< all are the same, not zero: likewise
  std::uint64_t unset_record_times = 0;  ///< recorded at time 0
  double recorder_step_s = 0.0;          ///< by which the recorder's clock was set back
  std::optional<double> rate_hz;         ///< of the median spacing of stamps
  std::optional<double> largest_gap_s;   ///< between stamps
  std::optional<double> loss;            ///< fraction of messages missing, from the spacings [-]
  std::optional<double> messages_per_stamp;  ///< of most messages, which come in batches
  std::uint64_t repeated = 0;                ///< stamps equal to the one before
  std::uint64_t backwards = 0;               ///< stamps before the one before
  std::optional<double> median_offset_s;     ///< record time minus stamp
  std::optional<double> smallest_offset_s;
  std::optional<double> largest_offset_s;
  std::optional<ClockOffset> clock;  ///< relative to the IMU, from the angular rates of both
  Time first_stamp = 0;              ///< of the header, or the record time
  Time last_stamp = 0;
};

struct PointFieldInfo {
  std::string name;
  std::string type;  ///< e.g. "float32"
  std::uint32_t offset = 0;
};

/// Layout of the clouds of a topic, from the first ones.
struct CloudInfo {
  std::string topic;
  std::string driver;                  ///< whose fields they are, e.g. "ouster-ros"; empty: unknown
  std::vector<PointFieldInfo> fields;  ///< of a Livox CustomMsg, those of its points
  std::size_t point_step = 0;          ///< [bytes]
  std::size_t height = 0;              ///< 1: not organised
  bool dense = false;                  ///< is_dense: declares that it contains no NaN
  std::uint64_t clouds = 0;            ///< number examined
  std::uint64_t broken = 0;            ///< unreadable ones met while examining these
  std::string first_broken;            ///< error of the first
  double mean_points = 0.0;            ///< per cloud
  double not_finite_fraction = 0.0;    ///< of the points [-]
  std::string repeated_text;           ///< where clouds are sent again under new stamps; else empty

  const PointFieldInfo* find(const std::string& name) const;
  const PointFieldInfo* time_field() const;  ///< nullptr: points have no time
  const PointFieldInfo* ring_field() const;  ///< nullptr: points have no ring

 private:
  const PointFieldInfo* find_any(std::span<const std::string_view> names) const;
};

/// The longest interval without motion, and the mean and noise of the IMU in it.
struct StaticInterval {
  double begin_s = 0.0;  ///< after the first sample
  double length_s = 0.0;
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();    ///< mean rate [rad/s]
  Eigen::Vector3d gyro_noise = Eigen::Vector3d::Zero();   ///< white noise density [rad/s/sqrt(Hz)]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();        ///< mean [m/s^2]
  Eigen::Vector3d force_noise = Eigen::Vector3d::Zero();  ///< white noise density [m/s^2/sqrt(Hz)]
};

struct ImuInfo {
  std::string topic;
  std::optional<double> new_rate_hz;  ///< of new samples, where each is sent several times
  bool in_g = false;                  ///< the specific force is in units of 9.80665 m/s^2
  bool oriented = false;              ///< its orientation is a unit quaternion
  std::optional<StaticInterval> static_interval;  ///< none: shorter than a second
};

/// A transform of tf: static, or the first one recorded.
struct TransformInfo {
  std::string parent;
  std::string child;
  Pose T_parent_child;
  bool fixed = false;
};

/// The data of `aims info` and `aims check`.
struct BagInfo {
  std::filesystem::path file;
  BagSummary summary;
  std::vector<TopicInfo> topics;  ///< by name
  std::vector<CloudInfo> clouds;
  std::vector<ImuInfo> imus;
  std::vector<TransformInfo> transforms;
  std::set<std::string> undefined;     ///< types without definition
  std::uint64_t undecodable = 0;       ///< messages that contradict their definition
  std::string first_undecodable;       ///< error of the first
  TopicsConfig used;                   ///< topics used by `aims estimate`; empty: none
  std::string leg_lack;                ///< why `aims estimate` reads no legs; empty: it does
  bool opens_without_lidar = false;    ///< refused, but not with recording.topics.lidar=none
  bool extrinsics_configured = false;  ///< T_imu_lidar of the configuration is used
  std::vector<std::string> notes;      ///< of `aims estimate`: assumptions and conversions
  std::map<std::string, StampFault> stamp_faults;  ///< that they state, by topic
  std::string times_text;              ///< where times of points cannot serve; else empty
  std::string rates_text;              ///< where clocks run at different rates; else empty
  std::optional<std::string> refusal;  ///< error of `aims estimate`, if it cannot read the bag
  std::vector<std::string> warnings;   ///< problems, each with its remedy

  const TopicInfo* find(const std::string& topic) const;
};

/// Reads every message of the bag once. Error when it cannot be opened or read to its end.
Result<BagInfo> bag_info(const std::filesystem::path& bag, const RecordingConfig& config,
                         BagOpenOptions options);

/// The info as text for the terminal.
std::string info_text(const BagInfo& info);

}  // namespace aims
