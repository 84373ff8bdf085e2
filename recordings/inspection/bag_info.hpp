// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/lie.hpp"
#include "recordings/bag/bag_reader.hpp"
#include "recordings/inspection/clock_offset.hpp"
#include "recordings/recording_config.hpp"

namespace aims {

/// When the messages of one topic came, and what their stamps say.
struct TopicInfo {
  std::string topic;
  std::string type;
  std::string frame;  ///< of the first header; empty: no header
  std::uint64_t messages = 0;
  bool stamped = false;                   ///< the type has a header
  std::optional<double> rate_hz;          ///< of the median spacing of stamps
  std::optional<double> largest_gap_s;    ///< between stamps
  std::optional<double> loss;             ///< share of messages that the spacings miss [-]
  std::uint64_t repeated = 0;             ///< stamps equal to the one before
  std::uint64_t backwards = 0;            ///< stamps before the one before
  std::optional<double> median_offset_s;  ///< record time minus stamp
  std::optional<double> smallest_offset_s;
  std::optional<double> largest_offset_s;
  std::optional<ClockOffset> clock;  ///< against the IMU, by the turns that both felt
  Time first_stamp = 0;              ///< of the header, or the record time
  Time last_stamp = 0;
};

struct PointFieldInfo {
  std::string name;
  std::string type;  ///< e.g. "float32"
  std::uint32_t offset = 0;
};

/// What the clouds of a topic are made of, from the first ones.
struct CloudInfo {
  std::string topic;
  std::vector<PointFieldInfo> fields;  ///< of a Livox CustomMsg, those of its points
  std::size_t point_step = 0;          ///< [bytes]
  std::size_t height = 0;              ///< 1: not organised
  bool dense = false;                  ///< says that it holds no NaN
  std::uint64_t clouds = 0;            ///< looked at
  std::uint64_t broken = 0;            ///< met before so many were looked at
  std::string first_broken;            ///< what was wrong with the first
  double mean_points = 0.0;            ///< per cloud
  double not_finite_share = 0.0;       ///< of the points [-]

  const PointFieldInfo* find(const std::string& name) const;
  const PointFieldInfo* time_field() const;  ///< nullptr: points carry no time
  const PointFieldInfo* ring_field() const;  ///< nullptr: points carry no ring

 private:
  const PointFieldInfo* find_any(std::span<const std::string_view> names) const;
};

/// The longest time at rest that an IMU saw, and what it read there.
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
  bool in_g = false;                   ///< the specific force is in units of 9.80665 m/s^2
  bool oriented = false;               ///< its orientation is a unit quaternion
  std::optional<StaticInterval> rest;  ///< none: it never stood for a second
};

/// A transform of tf: static, or the first one seen.
struct TransformInfo {
  std::string parent;
  std::string child;
  Pose T_parent_child;
  bool fixed = false;
};

/// Everything that `aims info` and `aims check` know of a bag.
struct BagInfo {
  std::filesystem::path file;
  BagSummary summary;
  std::vector<TopicInfo> topics;  ///< by name
  std::vector<CloudInfo> clouds;
  std::vector<ImuInfo> imus;
  std::vector<TransformInfo> transforms;
  std::uint64_t undecodable = 0;       ///< messages that do not fit their definition
  std::string first_undecodable;       ///< what was wrong with the first
  TopicsConfig used;                   ///< by `aims estimate`; empty where it finds none
  std::vector<std::string> notes;      ///< how `aims estimate` would read it
  std::optional<std::string> refusal;  ///< why `aims estimate` could not
  std::vector<std::string> warnings;   ///< what is odd, each with its remedy

  const TopicInfo* find(const std::string& topic) const;
};

/// Reads the whole bag once. Error when it cannot be opened or breaks off.
Result<BagInfo> bag_info(const std::filesystem::path& bag, const RecordingConfig& config,
                         BagOpenOptions options);

/// The info as it is shown on a terminal.
std::string info_text(const BagInfo& info);

}  // namespace aims
