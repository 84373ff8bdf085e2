// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/mcap/mcap_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace aims {
namespace {

/// Takes fields from a record's body; once one is missing, `complete` is false for good.
class BodyFields {
 public:
  explicit BodyFields(std::span<const std::byte> body) : cursor_(body) {}

  template <class T>
  T number() {
    const auto value = cursor_.number<T>();
    complete_ = complete_ && value;
    return value.value_or(T{});
  }

  std::span<const std::byte> bytes(std::uint64_t size) {
    const auto taken = cursor_.take(size);
    complete_ = complete_ && taken;
    return taken.value_or(std::span<const std::byte>());
  }

  std::string_view text() { return as_text(bytes(number<std::uint32_t>())); }

  /// The entries of an array or a map, whose length in bytes comes first.
  template <class Entry>
  void entries(const Entry& read) {
    BodyFields inside(bytes(number<std::uint32_t>()));
    while (inside.complete_ && inside.cursor_.left() > 0) read(inside);
    complete_ = complete_ && inside.complete_;
  }

  std::span<const std::byte> rest() { return bytes(cursor_.left()); }
  std::size_t position() const { return cursor_.position(); }
  bool complete() const { return complete_; }

 private:
  ByteCursor cursor_;
  bool complete_ = true;
};

template <class Record>
std::optional<Record> completed(const BodyFields& fields, Record record) {
  if (!fields.complete()) return std::nullopt;
  return record;
}

}  // namespace

std::string_view name_of(McapOp op) {
  static constexpr std::array<std::string_view, 15> kNames = {
      "a header",         "a footer",
      "a schema",         "a channel",
      "a message",        "a chunk",
      "a message index",  "a chunk index",
      "an attachment",    "an attachment index",
      "statistics",       "metadata",
      "a metadata index", "a summary offset",
      "the end of data"};
  const auto index = static_cast<std::size_t>(op) - 1;
  return index < kNames.size() ? kNames[index] : "an unknown record";
}

Result<McapRecord> read_mcap_record(ByteCursor& cursor) {
  const auto op = cursor.number<std::uint8_t>();
  const auto size = cursor.number<std::uint64_t>();
  if (!op || !size) {
    return failure(fmt::format("expected a record, but only {} bytes are left", cursor.left()));
  }
  const auto body = cursor.take(*size);
  if (!body) {
    return failure(fmt::format("expected {} bytes of {}, but only {} are left", *size,
                               name_of(static_cast<McapOp>(*op)), cursor.left()));
  }
  return McapRecord{static_cast<McapOp>(*op), *body};
}

std::optional<McapSchema> parse_schema(std::span<const std::byte> body) {
  BodyFields fields(body);
  McapSchema schema;
  schema.id = fields.number<std::uint16_t>();
  schema.name = fields.text();
  schema.encoding = fields.text();
  schema.text = fields.text();
  return completed(fields, schema);
}

std::string_view McapChannel::find(std::string_view key) const {
  const auto found =
      std::ranges::find(metadata, key, &std::pair<std::string_view, std::string_view>::first);
  return found == metadata.end() ? std::string_view() : found->second;
}

std::optional<McapChannel> parse_channel(std::span<const std::byte> body) {
  BodyFields fields(body);
  McapChannel channel;
  channel.id = fields.number<std::uint16_t>();
  channel.schema = fields.number<std::uint16_t>();
  channel.topic = fields.text();
  channel.encoding = fields.text();
  fields.entries([&channel](BodyFields& entry) {
    const std::string_view key = entry.text();
    channel.metadata.emplace_back(key, entry.text());
  });
  return completed(fields, std::move(channel));
}

std::optional<McapMessage> parse_message(std::span<const std::byte> body) {
  BodyFields fields(body);
  McapMessage message;
  message.channel = fields.number<std::uint16_t>();
  fields.number<std::uint32_t>();  // sequence number
  message.log_time = fields.number<std::uint64_t>();
  fields.number<std::uint64_t>();  // publish time
  message.data = fields.rest();
  return completed(fields, message);
}

std::optional<McapChunk> parse_chunk(std::span<const std::byte> body) {
  BodyFields fields(body);
  McapChunk chunk;
  chunk.start = fields.number<std::uint64_t>();
  chunk.end = fields.number<std::uint64_t>();
  chunk.size = fields.number<std::uint64_t>();
  chunk.crc = fields.number<std::uint32_t>();
  chunk.compression = fields.text();
  chunk.packed_size = fields.number<std::uint64_t>();
  chunk.header_size = fields.position();
  return completed(fields, chunk);
}

std::optional<McapChunkIndex> parse_chunk_index(std::span<const std::byte> body) {
  BodyFields fields(body);
  McapChunkIndex index;
  fields.bytes(2 * sizeof(std::uint64_t));  // times, which the chunk repeats
  index.position = fields.number<std::uint64_t>();
  index.length = fields.number<std::uint64_t>();
  fields.entries([&index](BodyFields& entry) {
    index.channels.push_back(entry.number<std::uint16_t>());
    entry.number<std::uint64_t>();  // position of the message index
  });
  index.index_length = fields.number<std::uint64_t>();
  return completed(fields, std::move(index));
}

std::optional<McapStatistics> parse_statistics(std::span<const std::byte> body) {
  BodyFields fields(body);
  McapStatistics statistics;
  statistics.messages = fields.number<std::uint64_t>();
  // Schemas, channels, attachments, metadata.
  fields.bytes(sizeof(std::uint16_t) + 3 * sizeof(std::uint32_t));
  statistics.chunks = fields.number<std::uint32_t>();
  fields.bytes(2 * sizeof(std::uint64_t));  // times
  fields.entries([&statistics](BodyFields& entry) {
    const auto channel = entry.number<std::uint16_t>();
    statistics.counts.emplace_back(channel, entry.number<std::uint64_t>());
  });
  return completed(fields, std::move(statistics));
}

std::optional<McapFooter> parse_footer(std::span<const std::byte> body) {
  BodyFields fields(body);
  McapFooter footer;
  footer.summary = fields.number<std::uint64_t>();
  fields.number<std::uint64_t>();  // position of the summary offsets
  footer.crc = fields.number<std::uint32_t>();
  return completed(fields, footer);
}

}  // namespace aims
