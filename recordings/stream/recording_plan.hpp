// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "recordings/bag/message_source.hpp"
#include "recordings/clouds/point_cloud.hpp"
#include "recordings/legs/leg_stream.hpp"
#include "recordings/stream/recording_reader.hpp"
#include "recordings/topics/recording_channels.hpp"

namespace aims {

/// Everything decided before the first message is given.
struct RecordingPlan {
  RecordingSetup setup;
  CloudReading cloud;
  double force_scale = 1.0;  ///< brings specific force to m/s^2
  LegStreamConfig legs;
  ContactRule contacts;
  Pose T_truth_body;             ///< the body in the frame of which truth is told
  bool truth_is_of_body = true;  ///< then its poses stay as they are
  Duration arrival_shift = 0;    ///< added to record times
  std::array<bool, kRoleCount> stamped_by_record{};  ///< no stamps: record times are taken
};

/// Looks at the start of a recording and decides how to read it; `notes` come before its own.
Result<RecordingPlan> plan_recording(MessageSource& bag, const RecordingConfig& config,
                                     const TopicsConfig& topics, const RecordingChannels& channels,
                                     std::vector<std::string> notes);

}  // namespace aims
