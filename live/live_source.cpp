// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_source.hpp"

#include <algorithm>
#include <utility>

#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"
#include "recordings/source/decided_start.hpp"
#include "recordings/source/joined_legs.hpp"
#include "recordings/source/split_imu.hpp"

namespace aims {

LiveSource::LiveSource(std::shared_ptr<LiveMessages> gathered, Wait wait)
    : gathered_(std::move(gathered)), wait_(std::move(wait)) {
  for (const LiveMessage& message : *gathered_) announce(*message.connection);
  summary_.messages = gathered_->size();
  if (gathered_->empty()) return;
  summary_.start = gathered_->front().arrival;
  summary_.end = gathered_->back().arrival;
  last_ = summary_.start;
}

void LiveSource::select(std::span<const std::string> topics) {
  selected_.emplace(topics.begin(), topics.end());
}

BagConnection* LiveSource::find(const BagConnection& connection) {
  const auto found = std::ranges::find_if(connections_, [&](const BagConnection& known) {
    return known.topic == connection.topic && known.type == connection.type &&
           known.md5 == connection.md5;
  });
  return found == connections_.end() ? nullptr : &*found;
}

void LiveSource::announce(const BagConnection& connection) {
  BagConnection* known = find(connection);
  if (known == nullptr) {
    known = &connections_.emplace_back(connection);
    known->id = static_cast<std::uint32_t>(connections_.size() - 1);
  }
  ++known->messages;
}

BagMessage LiveSource::as_recorded(const LiveMessage& message, const BagConnection& connection) {
  // A clock that was set back must not reverse the order of arrival.
  last_ = std::max(last_, message.arrival);
  return {.connection = &connection, .record_time = last_, .data = message.data};
}

/// Whether the clocks allow for reading on.
bool LiveSource::goes_on(const BagMessage& recorded, Time arrival) {
  if (!live_ || clocks_ == nullptr || recorded.connection->latching) return true;
  clocks_->add(recorded.connection->topic, stamps_->of(recorded), arrival);
  return clocks_->broken().empty();
}

void LiveSource::go_live(Observer observer, ClockWatch* clocks) {
  live_ = true;
  clocks_ = clocks;
  stamps_.emplace(connections_);
  observer_ = std::move(observer);
  if (!observer_) return;
  const Time now = std::exchange(last_, summary_.start);
  show(observer_);
  // Where the gathered ones end: a replay decides from the same.
  if (!connections_.empty()) show_mark(observer_, kDecidedTopic, last_, connections_[0].format);
  last_ = now;
}

void LiveSource::show(const Observer& observer) {
  for (const LiveMessage& message : *gathered_) {
    observer(as_recorded(message, *find(*message.connection)));
  }
}

/// The message after the last one; nullptr at the end.
const LiveMessage* LiveSource::following() {
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
  while (const LiveMessage* message = following()) {
    const BagConnection* connection = find(*message->connection);
    if (connection == nullptr) continue;
    const bool selected = selects(connection->topic);
    const BagMessage recorded = as_recorded(*message, *connection);
    if (selected && !goes_on(recorded, message->arrival)) return std::nullopt;
    if (observer_ && message == &current_) observer_(recorded);
    if (selected) return recorded;
  }
  return std::nullopt;
}

void LiveSource::rewind() {
  if (live_) return;
  position_ = 0;
  last_ = summary_.start;
}

void show_mark(const LiveSource::Observer& observer, const char* topic, Time record_time,
               MessageFormat format, const std::string& text) {
  const MessageType type =
      format == kRos2Format ? *known_ros2_type("std_msgs/String") : string_type();
  const BagConnection connection = {.topic = topic,
                                    .type = type.name,
                                    .md5 = type.md5,
                                    .definition = type.definition,
                                    .format = format};
  const auto message = string_message(text, format.serialization);
  observer({.connection = &connection, .record_time = record_time, .data = message.view()});
}

Result<RecordingReader> open_live(std::unique_ptr<LiveSource> source,
                                  const RecordingConfig& config) {
  std::unique_ptr<MessageSource> joined = std::move(source);
  join_split_imu(joined);
  join_single_legs(joined);
  return RecordingReader::open(std::move(joined), config);
}

}  // namespace aims
