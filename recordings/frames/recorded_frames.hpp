// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/event_counts.hpp"
#include "recordings/frames/frame_tree.hpp"
#include "recordings/recording_config.hpp"

namespace aims {

/// Where a recording's tf puts the sensors.
class RecordedFrames {
 public:
  /// Takes a message of tf; `fixed`: of /tf_static.
  void add(const MessageView& message, bool fixed);

  bool knows(std::string_view frame) const { return all_.knows(frame); }

  /// Frame `to` in frame `from`, by fixed transforms, else by /tf, which `notes` then say.
  std::optional<Pose> find(const std::string& from, const std::string& to,
                           std::vector<std::string>& notes) const;

  /// As configured, else as found, else the identity; `key` is the setting that gives it.
  Pose extrinsic(const ExtrinsicConfig& given, const std::string& from, const std::string& to,
                 std::string_view key, std::vector<std::string>& notes) const;

  /// Transforms that could not be used.
  const EventCounts& counts() const { return counts_; }

 private:
  FrameTree fixed_, all_;
  EventCounts counts_;
};

}  // namespace aims
