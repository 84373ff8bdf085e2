// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/decided_start.hpp"

#include <algorithm>

namespace aims {

bool is_of_live_estimate(const MessageSource& recording) {
  return std::ranges::find(recording.connections(), kDecidedTopic, &BagConnection::topic) !=
         recording.connections().end();
}

void DecidedStart::select(std::span<const std::string> topics) {
  std::vector<std::string> selected(topics.begin(), topics.end());
  selected.emplace_back(kDecidedTopic);
  recording_.select(selected);
}

Result<std::optional<BagMessage>> DecidedStart::next() {
  if (ended_) return std::nullopt;
  auto message = recording_.next();
  ended_ = message && *message && (*message)->connection->topic == kDecidedTopic;
  if (ended_) return std::nullopt;
  return message;
}

void DecidedStart::rewind() {
  ended_ = false;
  recording_.rewind();
}

}  // namespace aims
