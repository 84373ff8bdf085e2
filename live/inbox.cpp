// SPDX-License-Identifier: BSD-3-Clause
#include "live/inbox.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace aims {

Time wall_time() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

/// Whether `newer` replaces `older`, which waits.
bool Inbox::replaces(const LiveMessage& newer, const LiveMessage& older) const {
  return newer.connection == older.connection && newer.data.size() >= kLargeSize &&
         older.data.size() >= kLargeSize && newest_ - older.arrival > max_wait_large_;
}

void Inbox::push(LiveMessage message) {
  const std::lock_guard lock(mutex_);
  newest_ = message.arrival;
  const std::size_t before = messages_.size();
  if (message.data.size() >= kLargeSize) {
    std::erase_if(messages_, [&](const auto& waiting) { return replaces(message, waiting); });
  }
  while (!messages_.empty() && newest_ - messages_.front().arrival > kMaxWaitSmall) {
    messages_.pop_front();
  }
  dropped_ += before - messages_.size();
  messages_.push_back(std::move(message));
  arrived_.notify_one();
}

std::optional<LiveMessage> Inbox::pop() {
  while (!messages_.empty()) {
    LiveMessage message = std::move(messages_.front());
    messages_.pop_front();
    // Small ones are never replaced: a long queue of them is not searched, which would lengthen it.
    const bool replaced = message.data.size() >= kLargeSize &&
                          std::ranges::any_of(messages_, [&](const auto& waiting) {
                            return replaces(waiting, message);
                          });
    if (!replaced) return message;
    ++dropped_;
  }
  return std::nullopt;
}

std::optional<LiveMessage> Inbox::wait(double seconds, const std::function<bool()>& running) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  std::unique_lock lock(mutex_);
  while (messages_.empty()) {
    if (!running() || std::chrono::steady_clock::now() >= end) return std::nullopt;
    // A signal does not wake the condition.
    arrived_.wait_for(lock, std::chrono::milliseconds(50));
  }
  return pop();
}

void Inbox::limit_wait(Duration longest) {
  const std::lock_guard lock(mutex_);
  max_wait_large_ = longest;
}

std::size_t Inbox::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

}  // namespace aims
