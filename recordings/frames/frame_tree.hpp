// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/lie.hpp"
#include "recordings/event_counts.hpp"
#include "recordings/messages/message_decoder.hpp"

namespace aims {

/// Fixed transforms between named frames, as tf gives them. The first transform of a pair holds.
class FrameTree {
 public:
  /// False, and nothing learnt, for a transform that is none (not finite, no rotation), of a frame
  /// to itself, or beyond a thousand pairs.
  bool add(std::string_view parent, std::string_view child, const Pose& T_parent_child);

  /// Takes the transforms of a tf2_msgs/TFMessage or tf/tfMessage.
  void add(const MessageView& message, EventCounts& counts);

  bool knows(std::string_view frame) const { return neighbours_.contains(plain(frame)); }

  /// Frame `to` in frame `from`, along the shortest chain: a single transform keeps its very
  /// numbers. Nothing when the frames are not connected.
  std::optional<Pose> transform(std::string_view from, std::string_view to) const;

  /// The frames of that chain, both ends included; empty when there is none.
  std::vector<std::string> chain(std::string_view from, std::string_view to) const;

 private:
  /// Without the slash that old drivers put in front.
  static std::string plain(std::string_view frame);

  /// By frame, the poses of its neighbours in it.
  std::map<std::string, std::map<std::string, Pose>> neighbours_;
  std::size_t pairs_ = 0;
};

}  // namespace aims
