// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/derived_source.hpp"

#include <algorithm>
#include <utility>

namespace aims {

DerivedSource::DerivedSource(std::unique_ptr<MessageSource> source)
    : WrappedSource(std::move(source)), last_(summary().start) {
  for (const BagConnection& each : connections_) {
    recorded_.insert(each.id);
    wanted_.insert(each.id);
  }
}

std::uint32_t DerivedSource::add_topic(std::string topic, const MessageType& type,
                                       std::uint64_t messages, const std::set<std::uint32_t>& from,
                                       std::string joined_from) {
  BagConnection added;
  for (const BagConnection& each : connections_) added.id = std::max(added.id, each.id + 1);
  added.topic = std::move(topic);
  added.type = type.name;
  added.md5 = type.md5;
  added.definition = type.definition;
  added.joined_from = std::move(joined_from);
  const bool elsewhere = std::ranges::any_of(connections_, [&](const BagConnection& each) {
    return recorded_.contains(each.id) && !from.contains(each.id) && each.type == type.name &&
           each.messages > 0 && !each.is_part;
  });
  added.messages = elsewhere && !from.empty() ? 0 : messages;
  const std::uint32_t id = added.id;
  connections_.push_back(std::move(added));
  from_[id] = from;
  wanted_.insert(id);
  seen_.insert(from.begin(), from.end());
  return id;
}

std::uint64_t DerivedSource::mark_parts(const std::set<std::uint32_t>& ids) {
  std::uint64_t messages = 0;
  for (BagConnection& each : connections_) {
    if (!ids.contains(each.id)) continue;
    each.is_part = true;
    messages += each.messages;
  }
  return messages;
}

void DerivedSource::select(std::span<const std::string> topics) {
  wanted_.clear();
  seen_.clear();
  std::set<std::string> needed;
  for (const BagConnection& each : connections_) {
    if (std::ranges::find(topics, each.topic) == topics.end()) continue;
    wanted_.insert(each.id);
    if (recorded_.contains(each.id)) needed.insert(each.topic);
    const auto from = from_.find(each.id);
    if (from == from_.end()) continue;
    seen_.insert(from->second.begin(), from->second.end());
    for (const std::uint32_t id : from->second) needed.insert(connection(id)->topic);
  }
  source_.select(std::vector<std::string>(needed.begin(), needed.end()));
}

void DerivedSource::give(std::uint32_t id, Time record_time, MessageBytes bytes) {
  made_.push_back({id, record_time, std::move(bytes)});
}

/// The next message that was made, if it is wanted.
std::optional<BagMessage> DerivedSource::take() {
  while (!made_.empty()) {
    lent_ = std::move(made_.front());
    made_.pop_front();
    if (!wanted_.contains(lent_->id)) continue;
    return BagMessage{connection(lent_->id), lent_->time, lent_->bytes.view(), 0};
  }
  return std::nullopt;
}

Result<std::optional<BagMessage>> DerivedSource::next() {
  while (true) {
    if (auto made = take()) return made;
    auto message = read();
    if (!message) return message;
    if (!*message) {
      finish(last_);
      return take();
    }
    last_ = (*message)->record_time;
    const std::uint32_t id = (*message)->connection->id;
    if (seen_.contains(id)) {
      if (auto seen = see(**message); !seen) return tl::unexpected(seen.error());
    }
    if (wanted_.contains(id)) return message;
  }
}

void DerivedSource::rewind() {
  WrappedSource::rewind();
  made_.clear();
  lent_.reset();
  last_ = summary().start;
  restart();
}

}  // namespace aims
