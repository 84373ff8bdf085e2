// SPDX-License-Identifier: BSD-3-Clause
#include "ros/live_source.hpp"

#include <algorithm>
#include <utility>

namespace aims {

LiveSource::LiveSource(std::shared_ptr<RosMessages> gathered, Wait wait)
    : gathered_(std::move(gathered)), wait_(std::move(wait)) {
  for (const RosMessage& message : *gathered_) announce(*message.connection);
  summary_.messages = gathered_->size();
  if (gathered_->empty()) return;
  summary_.start = gathered_->front().arrival;
  summary_.end = gathered_->back().arrival;
  last_ = summary_.start;
}

void LiveSource::select(std::span<const std::string> topics) {
  selected_.emplace(topics.begin(), topics.end());
}

const BagConnection* LiveSource::find(const RosConnection& connection) const {
  const auto found = std::ranges::find_if(connections_, [&](const BagConnection& known) {
    return known.topic == connection.topic && known.type == connection.type &&
           known.md5 == connection.md5;
  });
  return found == connections_.end() ? nullptr : &*found;
}

void LiveSource::announce(const RosConnection& connection) {
  if (find(connection) == nullptr) {
    connections_.push_back({.id = static_cast<std::uint32_t>(connections_.size()),
                            .topic = connection.topic,
                            .type = connection.type,
                            .md5 = connection.md5,
                            .definition = connection.definition,
                            .latching = connection.latching});
  }
  for (BagConnection& known : connections_) known.messages += &known == find(connection) ? 1 : 0;
}

/// The message as read from a bag; nothing for one that is not selected.
std::optional<BagMessage> LiveSource::given(const RosMessage& message) {
  const BagConnection* connection = find(*message.connection);
  if (connection == nullptr) return std::nullopt;
  if (!selects(connection->topic)) return std::nullopt;
  // A clock that was set back must not reverse the order of arrival.
  last_ = std::max(last_, message.arrival);
  return BagMessage{.connection = connection, .record_time = last_, .data = message.data};
}

/// The message after the last one; nullptr at the end.
const RosMessage* LiveSource::following() {
  if (position_ < gathered_->size()) {
    return &(*gathered_)[position_++];
  }
  if (!live_) return nullptr;
  gathered_->clear();
  position_ = 0;
  auto message = wait_();
  if (!message) return nullptr;
  current_ = std::move(*message);
  return &current_;
}

Result<std::optional<BagMessage>> LiveSource::next() {
  while (const RosMessage* message = following()) {
    if (auto wanted = given(*message)) return wanted;
  }
  return std::nullopt;
}

void LiveSource::rewind() {
  if (live_) return;
  position_ = 0;
  last_ = summary_.start;
}

}  // namespace aims
