// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/lie.hpp"
#include "recordings/event_counts.hpp"
#include "recordings/messages/message_decoder.hpp"

namespace aims {

/// Fixed transforms between named frames of tf. The first transform of a pair is kept.
class FrameTree {
 public:
  /// False, without effect, for an invalid transform (not finite, no rotation), of a frame to
  /// itself, or beyond a thousand pairs.
  bool add(std::string_view parent, std::string_view child, const Pose& T_parent_child);

  /// Adds the transforms of a tf2_msgs/TFMessage or tf/tfMessage.
  void add(const MessageView& message, EventCounts& counts);

  bool contains(std::string_view frame) const { return neighbours_.contains(plain(frame)); }

  /// Frame `to` in frame `from`, along the shortest chain; a single transform is returned
  /// unchanged. Nothing when the frames are not connected.
  std::optional<Pose> transform(std::string_view from, std::string_view to) const;

  /// The frames of that chain, both ends included; empty when there is none.
  std::vector<std::string> chain(std::string_view from, std::string_view to) const;

  /// What contradicts that chain: two frames of it that are joined in another way too.
  struct Contradiction {
    std::string from, to;
    double distance = 0.0;  ///< [m]
    double angle = 0.0;     ///< [rad]
  };
  std::optional<Contradiction> contradiction(std::string_view from, std::string_view to) const;

 private:
  /// The name without the leading slash of old drivers.
  static std::string plain(std::string_view frame);

  /// Poses of the neighbours in each frame.
  std::map<std::string, std::map<std::string, Pose>> neighbours_;
  std::size_t pairs_ = 0;
  struct Other {
    Pose pose;                        ///< of the pair, by another message or chain
    std::vector<std::string> frames;  ///< of that chain and the pair
  };
  std::map<std::pair<std::string, std::string>, Other> others_;  ///< that differ, by pair
};

}  // namespace aims
