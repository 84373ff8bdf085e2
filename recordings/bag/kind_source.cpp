// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/bag/kind_source.hpp"

#include <algorithm>

#include "recordings/bag/compression.hpp"

namespace aims {

KindSource::KindSource(std::span<const Kind> kinds, std::uint64_t file_size)
    : chosen_(kinds.size(), true) {
  for (const Kind& kind : kinds) {
    BagConnection connection;
    connection.id = static_cast<std::uint32_t>(connections_.size());
    connection.topic = kind.topic;
    connection.type = kind.type.name;
    connection.md5 = kind.type.md5;
    connection.definition = kind.type.definition;
    connection.latching = kind.latching;
    connections_.push_back(std::move(connection));
  }
  summary_.file_size = file_size;
  summary_.chunks = 1;
  summary_.compression = name_of(BagCompression::kNone);
}

Result<void> KindSource::count() {
  rewind();
  while (true) {
    const auto made = make();
    if (!made) return tl::unexpected(made.error());
    if (!*made) break;
    if (summary_.messages == 0) summary_.start = (*made)->record_time;
    summary_.end = (*made)->record_time;
    ++summary_.messages;
    ++connections_[(*made)->kind].messages;
  }
  std::erase_if(connections_, [](const BagConnection& each) { return each.messages == 0; });
  rewind();
  return {};
}

void KindSource::select(std::span<const std::string> topics) {
  for (const BagConnection& each : connections_) {
    chosen_[each.id] = std::ranges::find(topics, each.topic) != topics.end();
  }
}

Result<std::optional<BagMessage>> KindSource::next() {
  while (true) {
    const auto made = make();
    if (!made) return tl::unexpected(made.error());
    if (!*made) return std::optional<BagMessage>();
    if (!chosen_[(*made)->kind]) continue;
    const auto connection = std::ranges::find(connections_, (*made)->kind, &BagConnection::id);
    return BagMessage{&*connection, (*made)->record_time, (*made)->data, (*made)->offset};
  }
}

}  // namespace aims
