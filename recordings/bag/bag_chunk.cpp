// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/bag/bag_chunk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace aims {
namespace {

/// Largest ratio of unpacked to packed bytes that lz4 can reach.
constexpr std::uint64_t kMaxLz4Ratio = 256;

std::string text_of(const RecordFields& fields, std::string_view name) {
  return std::string(fields.text(name).value_or(""));
}

Result<void> add_message(const BagRecord& record, std::size_t offset,
                         const BagConnections& connections, ChunkContent& content) {
  const auto id = record.header.number<std::uint32_t>("conn");
  const auto time = record.header.time("time");
  if (!id || !time) return failure("expected a message with 'conn' and 'time'");
  if (connections.find(*id) == nullptr) {
    return failure(fmt::format("a message of connection {}, which no record announces", *id));
  }
  const auto data_offset = static_cast<std::uint32_t>(record.data.data() - content.bytes.data());
  content.messages.push_back({*time, *id, static_cast<std::uint32_t>(offset), data_offset,
                              static_cast<std::uint32_t>(record.data.size())});
  return {};
}

Result<void> find_messages(BagConnections& connections, ChunkContent& content,
                           std::size_t& offset) {
  content.messages.clear();
  ByteCursor cursor(content.bytes);
  while (cursor.left() > 0) {
    offset = cursor.position();
    const auto record = read_record(cursor);
    if (!record) return tl::unexpected(record.error());
    Result<void> added;
    if (record->op == BagOp::kConnection) {
      added = connections.add(record->header, record->data);
    } else if (record->op == BagOp::kMessage) {
      added = add_message(*record, offset, connections, content);
    } else {
      return failure(
          fmt::format("expected a message or a connection, found {}", name_of(record->op)));
    }
    if (!added) return added;
  }
  return {};
}

Result<void> check_counts(const BagFile& file, const ChunkPlace& place,
                          const ChunkContent& content) {
  std::map<std::uint32_t, std::uint32_t> counts;
  for (const ChunkMessage& message : content.messages) {
    ++counts[message.connection];
    if (message.time < place.start || message.time > place.end) {
      return refuse_in_chunk(
          file, place, message.offset,
          fmt::format("expected a record time from {} to {} ns, as the index states, found {}",
                      place.start, place.end, message.time));
    }
  }
  for (const auto& [id, count] : place.counts) {
    if (counts[id] != count) {
      return file.refuse(
          place.position,
          fmt::format(
              "expected {} messages of connection {} in this chunk, as the index states, found {}",
              count, id, counts[id]));
    }
  }
  const auto listed = [&](const auto& each) { return place.counts.contains(each.first); };
  const auto extra = std::find_if_not(counts.begin(), counts.end(), listed);
  if (extra == counts.end()) return {};
  return file.refuse(
      place.position,
      fmt::format("{} messages of connection {} in this chunk, which the index omits",
                  extra->second, extra->first));
}

}  // namespace

Result<void> BagConnections::add(const RecordFields& header, std::span<const std::byte> data) {
  const auto id = header.number<std::uint32_t>("conn");
  const auto topic = header.text("topic");
  if (!id || !topic) return failure("expected a connection with 'conn' and 'topic'");
  const auto fields = RecordFields::parse(data);
  if (!fields) return failure("in a connection's data: " + fields.error().message);
  if (!fields->find("type") || !fields->find("md5sum")) {
    return failure(fmt::format("expected 'type' and 'md5sum' of connection {}", *id));
  }
  BagConnection connection{*id,
                           std::string(*topic),
                           text_of(*fields, "type"),
                           text_of(*fields, "md5sum"),
                           text_of(*fields, "message_definition"),
                           fields->text("latching") == "1",
                           0,
                           kRos1Format};
  const auto [place, added] = by_id_.try_emplace(*id, std::move(connection));
  if (added) return {};
  const BagConnection& known = place->second;
  const BagConnection& found = connection;
  if (known.topic == found.topic && known.type == found.type && known.md5 == found.md5) return {};
  return failure(fmt::format("connection {} is '{}' of {}, but was announced as '{}' of {}", *id,
                             found.topic, found.type, known.topic, known.type));
}

const BagConnection* BagConnections::find(std::uint32_t id) const {
  const auto found = by_id_.find(id);
  return found == by_id_.end() ? nullptr : &found->second;
}

BagConnection* BagConnections::find(std::uint32_t id) {
  return const_cast<BagConnection*>(std::as_const(*this).find(id));
}

void BagConnections::reset_counts() {
  for (auto& [id, connection] : by_id_) connection.messages = 0;
}

Result<ChunkPlace> chunk_place(const BagFile& file, const FileRecord& record) {
  if (record.op != BagOp::kChunk) {
    return file.refuse(record.position,
                       fmt::format("expected a chunk, found {}", name_of(record.op)));
  }
  const auto name = record.header.text("compression");
  const auto size = record.header.number<std::uint32_t>("size");
  if (!name || !size) {
    return file.refuse(record.position, "expected a chunk with 'compression' and 'size'");
  }
  const auto compression = compression_named(*name);
  if (!compression || *compression == BagCompression::kZstd) {
    return file.refuse(
        record.position,
        fmt::format("expected compression none, lz4 or bz2, found '{}'", name->substr(0, 32)));
  }
  ChunkPlace place;
  place.position = record.position;
  place.data_position = record.data_position;
  place.packed_size = record.data_size;
  place.size = *size;
  place.compression = *compression;
  const bool none = *compression == BagCompression::kNone;
  const bool lz4 = *compression == BagCompression::kLz4;
  if ((none && *size != record.data_size) ||
      (lz4 && *size > kMaxLz4Ratio * record.data_size + kMaxLz4Ratio)) {
    return file.refuse(record.position,
                       fmt::format("a chunk of {} bytes cannot be packed into {} bytes ({})", *size,
                                   record.data_size, *name));
  }
  return place;
}

Result<void> load_chunk(const BagFile& file, const ChunkPlace& place, BagConnections& connections,
                        ChunkContent& content) {
  if (auto got = unpack_chunk(file, place, content); !got) return got;
  std::size_t offset = 0;
  const auto found = find_messages(connections, content, offset);
  if (!found) return refuse_in_chunk(file, place, offset, found.error().message);
  return {};
}

Result<void> check_chunk_index(const BagFile& file, const ChunkPlace& place,
                               const ChunkContent& content) {
  if (auto agree = check_counts(file, place, content); !agree) return agree;
  std::uint64_t position = place.end_position();
  std::size_t listed = 0;
  for (std::uint32_t i = 0; i < place.index_records; ++i) {
    const auto record = file.record(position);
    if (!record) return tl::unexpected(record.error());
    const auto id = record->header.number<std::uint32_t>("conn");
    const auto version = record->header.number<std::uint32_t>("ver");
    if (record->op != BagOp::kIndex || !id || version != 1U) {
      return file.refuse(position, fmt::format("expected an index record of version 1 behind the "
                                               "chunk, found {}",
                                               name_of(record->op)));
    }
    const auto entries = file.data(*record, content.messages.size() * kIndexEntrySize);
    if (!entries) return tl::unexpected(entries.error());
    for (std::size_t at = 0; at + kIndexEntrySize <= entries->size(); at += kIndexEntrySize) {
      const Time time = load_time(entries->data() + at);
      const auto offset = load_number<std::uint32_t>(entries->data() + at + 8);
      const auto found = std::lower_bound(
          content.messages.begin(), content.messages.end(), offset,
          [](const ChunkMessage& each, std::uint32_t o) { return each.offset < o; });
      if (found == content.messages.end() || found->offset != offset || found->time != time ||
          found->connection != *id) {
        return file.refuse(record->data_position + at,
                           fmt::format("the index lists a message of connection {} at byte {} "
                                       "of the chunk, which is not there",
                                       *id, offset));
      }
      ++listed;
    }
    position = record->end();
  }
  if (listed == content.messages.size()) return {};
  return file.refuse(place.end_position(),
                     fmt::format("expected {} index entries behind the chunk, found {}",
                                 content.messages.size(), listed));
}

}  // namespace aims
