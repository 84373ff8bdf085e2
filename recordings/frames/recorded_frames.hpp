// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/event_counts.hpp"
#include "recordings/frames/frame_tree.hpp"
#include "recordings/reading_notes.hpp"
#include "recordings/recording_config.hpp"

namespace aims {

/// Sensor extrinsics from a recording's tf.
class RecordedFrames {
 public:
  /// Adds a message of tf; `fixed`: of /tf_static.
  void add(const MessageView& message, bool fixed);

  bool contains(std::string_view frame) const { return all_.contains(frame); }

  /// Frame `to` in frame `from`, from fixed transforms, else from /tf with a line in `notes`.
  std::optional<Pose> find(const std::string& from, const std::string& to,
                           ReadingNotes& notes) const;

  /// As configured, else from tf, else the identity; `key` is its setting.
  Pose extrinsic(const ExtrinsicConfig& configured, const std::string& from, const std::string& to,
                 std::string_view key, ReadingNotes& notes) const;

  /// Where a sensor lies that was in frame `before` and is in frame `now`: in words, empty where it
  /// is the same place.
  std::string moved(const std::string& before, const std::string& now) const;

  /// Counts of invalid transforms.
  const EventCounts& counts() const { return counts_; }

 private:
  FrameTree fixed_, all_;
  EventCounts counts_;
};

}  // namespace aims
