// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "recordings/bag/message_source.hpp"
#include "recordings/clouds/point_cloud.hpp"
#include "recordings/frames/recorded_frames.hpp"
#include "recordings/legs/leg_stream.hpp"
#include "recordings/reading_notes.hpp"
#include "recordings/stream/recording_reader.hpp"
#include "recordings/topics/recording_channels.hpp"

namespace aims {

/// Everything decided before the first message is delivered.
struct RecordingPlan {
  RecordingSetup setup;
  CloudReading cloud;
  double force_scale = 1.0;  ///< scales specific force to m/s^2
  double turn_scale = 1.0;   ///< scales angular velocity to rad/s
  LegStreamConfig legs;
  JointRule joints;
  ContactRule contacts;
  Pose T_truth_body;                  ///< body pose in the frame of the truth
  bool truth_is_of_body = true;       ///< then its poses are used unchanged
  Duration arrival_shift = 0;         ///< added to record times
  std::optional<double> record_rate;  ///< at which they run faster than the stamps
  Time start = 0;                     ///< earliest record time that was set
  std::optional<Time> begin;          ///< record time before which there is an IMU alone: left out
  std::array<std::optional<Duration>, kRoleCount> latency;  ///< record time minus stamp, typically
  /// The stamps leap though the record times do not: they say nothing of when a message arrived.
  std::array<bool, kRoleCount> leaps{};
  /// A message that is recorded earlier than its stamp and latency by more has a wrong record time.
  Duration max_early = kSecond / 2;
  Duration max_hold = 60 * kSecond;         ///< of such a message, until its stamp
  std::array<Duration, kRoleCount> wait{};  ///< of messages, for those whose stamps move back more
  std::map<std::string, Duration> repeat_period;     ///< of topics that send each sample repeatedly
  std::array<bool, kRoleCount> stamped_by_record{};  ///< without stamps: record times are used
  std::string lidar_frame;                           ///< of the first clouds; empty: none
  RecordedFrames frames;                             ///< for a cloud in another frame than they
  /// Of topics of joints and contacts beside others of legs; 0: there is none.
  Duration joint_period = 0, contact_period = 0;
};

/// The configured delay of the stamps that serve a role; 0 for the truth [s].
double delay_of(const RecordingConfig& config, Role role);

/// Looks at the start of a recording and decides how to read it; its notes follow `notes`.
Result<RecordingPlan> plan_recording(MessageSource& bag, const RecordingConfig& config,
                                     const TopicsConfig& topics, const RecordingChannels& channels,
                                     std::vector<std::string> notes);

}  // namespace aims
