// SPDX-License-Identifier: BSD-3-Clause
#include "live/inbox.hpp"

#include <algorithm>
#include <utility>

namespace aims {

/// Whether `newer` replaces `older`, which waits.
bool Inbox::replaces(const LiveMessage& newer, const LiveMessage& older) const {
  return newer.connection == older.connection && newer.data.size() >= kLargeSize &&
         older.data.size() >= kLargeSize && newest_ - older.arrival > max_wait_large_;
}

void Inbox::push(LiveMessage message) {
  newest_ = message.arrival;
  const std::size_t before = messages_.size();
  if (message.data.size() >= kLargeSize) {
    const auto kept = std::remove_if(messages_.begin(), messages_.end(), [&](const auto& waiting) {
      return replaces(message, waiting);
    });
    messages_.erase(kept, messages_.end());
  }
  while (!messages_.empty() && newest_ - messages_.front().arrival > kMaxWaitSmall) {
    messages_.pop_front();
  }
  dropped_ += before - messages_.size();
  messages_.push_back(std::move(message));
}

std::optional<LiveMessage> Inbox::pop() {
  while (!messages_.empty()) {
    LiveMessage message = std::move(messages_.front());
    messages_.pop_front();
    const bool replaced = std::any_of(messages_.begin(), messages_.end(), [&](const auto& waiting) {
      return replaces(waiting, message);
    });
    if (!replaced) return message;
    ++dropped_;
  }
  return std::nullopt;
}

}  // namespace aims
