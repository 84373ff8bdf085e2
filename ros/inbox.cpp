// SPDX-License-Identifier: BSD-3-Clause
#include "ros/inbox.hpp"

#include <algorithm>
#include <utility>

namespace aims {

void Inbox::push(RosMessage message) {
  const std::int64_t now = message.arrival;
  messages_.push_back(std::move(message));
  if (now - messages_.front().arrival <= kMaxWaitLarge) return;
  const auto kept = std::remove_if(messages_.begin(), messages_.end(), [now](const auto& waiting) {
    const bool large = waiting.data.size() >= kLargeSize;
    return now - waiting.arrival > (large ? kMaxWaitLarge : kMaxWaitSmall);
  });
  dropped_ += static_cast<std::size_t>(messages_.end() - kept);
  messages_.erase(kept, messages_.end());
}

std::optional<RosMessage> Inbox::pop() {
  if (messages_.empty()) return std::nullopt;
  RosMessage message = std::move(messages_.front());
  messages_.pop_front();
  return message;
}

}  // namespace aims
