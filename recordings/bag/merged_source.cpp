// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/bag/merged_source.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace aims {

void MergedSource::add(std::unique_ptr<MessageSource> source, Duration shift) {
  Part part;
  part.shift = shift;
  part.source = std::move(source);
  join_connections(part);
  add_summary(part.source->summary(), shift);
  parts_.push_back(std::move(part));
}

void MergedSource::join_connections(Part& part) {
  for (const BagConnection& each : part.source->connections()) {
    const Key key = {each.topic, each.type, each.definition, each.format.serialization,
                     each.latching};
    const auto id = static_cast<std::uint32_t>(connections_.size());
    const auto [known, added] = places_.emplace(key, id);
    part.places.resize(std::max<std::size_t>(part.places.size(), each.id + 1));
    part.places[each.id] = known->second;
    if (added) {
      connections_.push_back(each);
      connections_.back().id = id;
    } else {
      connections_[known->second].messages += each.messages;
    }
  }
}

void MergedSource::add_summary(const BagSummary& part, Duration shift) {
  ++summary_.chunks;
  summary_.file_size += part.file_size;
  summary_.lost_bytes += part.lost_bytes;
  summary_.indexed = summary_.indexed && part.indexed;
  summary_.closed = summary_.closed && part.closed;
  summary_.lost_messages += part.lost_messages;
  summary_.untimed_rows += part.untimed_rows;
  summary_.lost_packets = std::max(summary_.lost_packets, part.lost_packets);
  compressions_.insert(part.compression);
  summary_.compression = fmt::format("{}", fmt::join(compressions_, ", "));
  if (part.messages == 0) return;
  const bool first = summary_.messages == 0;
  const Time start = part.start + shift, end = part.end + shift;
  summary_.start = first ? start : std::min(summary_.start, start);
  summary_.end = first ? end : std::max(summary_.end, end);
  if (std::abs(shift) > std::abs(summary_.clock_shift)) summary_.clock_shift = shift;
  summary_.messages += part.messages;
}

Result<std::optional<std::size_t>> MergedSource::earliest() {
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    // A part that begins later is not touched yet: it may need much memory.
    const bool later =
        first && parts_[*first].waiting->record_time < part.source->summary().start + part.shift;
    if (!part.waiting && !part.ended && !later) {
      auto message = part.source->next();
      if (!message) return tl::unexpected(message.error());
      part.waiting = *message;
      if (part.waiting) part.waiting->record_time += part.shift;
      part.ended = !part.waiting;
    }
    if (!part.waiting) continue;
    if (!first || part.waiting->record_time < parts_[*first].waiting->record_time) first = i;
  }
  return first;
}

void MergedSource::select(std::span<const std::string> topics) {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    part.source->select(topics);
    const bool chosen =
        part.waiting && std::ranges::find(topics, part.waiting->connection->topic) != topics.end();
    if (!chosen && i != lent_) part.waiting.reset();
  }
}

/// Drops the same message of other parts: files that overlap hold it twice.
void MergedSource::drop_copies(std::size_t first) {
  const Part& chosen = parts_[first];
  const BagMessage& message = *chosen.waiting;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    std::optional<BagMessage>& other = parts_[i].waiting;
    if (i == first || !other || other->record_time != message.record_time) continue;
    if (parts_[i].places[other->connection->id] != chosen.places[message.connection->id]) continue;
    if (!std::ranges::equal(other->data, message.data)) continue;
    other.reset();
    ++summary_.repeated_messages;
  }
}

Result<std::optional<BagMessage>> MergedSource::next() {
  if (lent_) parts_[*std::exchange(lent_, std::nullopt)].waiting.reset();
  const auto first = earliest();
  if (!first) return tl::unexpected(first.error());
  if (!*first) return std::optional<BagMessage>();
  lent_ = *first;
  drop_copies(**first);
  const Part& part = parts_[**first];
  BagMessage message = *part.waiting;
  message.connection = &connections_[part.places[message.connection->id]];
  return std::optional<BagMessage>(message);
}

void MergedSource::rewind() {
  lent_.reset();
  summary_.repeated_messages = 0;
  for (Part& part : parts_) {
    part.waiting.reset();
    part.ended = false;
    part.source->rewind();
  }
}

}  // namespace aims
