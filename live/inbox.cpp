// SPDX-License-Identifier: BSD-3-Clause
#include "live/inbox.hpp"

#include <algorithm>
#include <utility>

namespace aims {

void Inbox::push(LiveMessage message) {
  const std::int64_t now = message.arrival;
  messages_.push_back(std::move(message));
  if (now - messages_.front().arrival <= max_wait_large_) return;
  const auto kept =
      std::remove_if(messages_.begin(), messages_.end(), [this, now](const auto& waiting) {
        const bool large = waiting.data.size() >= kLargeSize;
        return now - waiting.arrival > (large ? max_wait_large_ : kMaxWaitSmall);
      });
  dropped_ += static_cast<std::size_t>(messages_.end() - kept);
  messages_.erase(kept, messages_.end());
}

std::optional<LiveMessage> Inbox::pop() {
  if (messages_.empty()) return std::nullopt;
  LiveMessage message = std::move(messages_.front());
  messages_.pop_front();
  return message;
}

}  // namespace aims
