// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "ros/ros_message.hpp"

namespace aims {

/// Messages that wait for a busy node, in order of arrival. One that has waited too long is left
/// out and counted: a large one, a cloud, soon, since it costs most and the next one tells the
/// same; a small one late, since an estimator cannot do without. Memory is bounded by these spans.
class Inbox {
 public:
  static constexpr std::size_t kLarge = 16384;                    ///< from here on [bytes]
  static constexpr std::int64_t kLongestWaitLarge = 2000000000;   ///< [ns]
  static constexpr std::int64_t kLongestWaitSmall = 20000000000;  ///< [ns]

  void push(RosMessage message);
  std::optional<RosMessage> pop();
  bool empty() const { return messages_.empty(); }

  /// Messages left out so far.
  std::size_t dropped() const { return dropped_; }

 private:
  std::deque<RosMessage> messages_;
  std::size_t dropped_ = 0;
};

}  // namespace aims
