// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "live/message.hpp"

namespace aims {

/// Queue of messages for a busy node, in order of arrival. What has waited too long is dropped and
/// counted. A large message (a cloud) is early, once a newer one of its topic waits, which replaces
/// it: no cloud starts later than its limit after its arrival, however slow the node is, unless it
/// is the newest. A small one, on which an estimator depends, is late. This bounds the memory.
class Inbox {
 public:
  static constexpr std::size_t kLargeSize = 16384;            ///< size of a large message [bytes]
  static constexpr std::int64_t kMaxWaitLarge = 2000000000;   ///< [ns]
  static constexpr std::int64_t kMaxWaitSmall = 20000000000;  ///< [ns]

  void push(LiveMessage message);
  /// The oldest message that is not replaced; nothing when none waits.
  std::optional<LiveMessage> pop();
  bool empty() const { return messages_.empty(); }

  /// The longest wait of a large message from now on [ns].
  void limit_wait(std::int64_t longest) { max_wait_large_ = longest; }

  /// Messages dropped so far.
  std::size_t dropped() const { return dropped_; }

 private:
  bool replaces(const LiveMessage& newer, const LiveMessage& older) const;

  std::deque<LiveMessage> messages_;
  std::int64_t newest_ = 0;  ///< arrival [ns]
  std::int64_t max_wait_large_ = kMaxWaitLarge;
  std::size_t dropped_ = 0;
};

}  // namespace aims
