// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/time.hpp"
#include "recordings/bag/message_source.hpp"

namespace aims {

/// This computer's time, since the epoch.
Time wall_time();

/// A message from the network.
struct LiveMessage {
  std::shared_ptr<const BagConnection> connection;  ///< of one publisher; its id is 0
  Time arrival = 0;                                 ///< since the epoch
  std::vector<std::byte> data;
};

/// Queue of messages for a busy node, in order of arrival; for several threads. What has waited too
/// long is dropped and counted. A large message (a cloud) is early, once a newer one of its topic
/// waits, which replaces it: no cloud starts later than its limit after its arrival, however slow
/// the node is, unless it is the newest. A small one, on which an estimator depends, is late. This
/// bounds the memory.
class Inbox {
 public:
  static constexpr std::size_t kLargeSize = 16384;  ///< size of a large message [bytes]
  static constexpr Duration kMaxWaitLarge = 2 * kSecond;
  static constexpr Duration kMaxWaitSmall = 20 * kSecond;

  void push(LiveMessage message);
  /// The oldest message that is not replaced; nothing after `seconds`, or once `running` is false.
  std::optional<LiveMessage> wait(double seconds, const std::function<bool()>& running);

  /// The longest wait of a large message from now on.
  void limit_wait(Duration longest);

  /// Messages dropped so far.
  std::size_t dropped() const;

 private:
  bool replaces(const LiveMessage& newer, const LiveMessage& older) const;
  std::optional<LiveMessage> pop();

  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<LiveMessage> messages_;
  Time newest_ = 0;  ///< arrival
  Duration max_wait_large_ = kMaxWaitLarge;
  std::size_t dropped_ = 0;
};

}  // namespace aims
