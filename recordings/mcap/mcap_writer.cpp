// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/mcap/mcap_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/files/crc32.hpp"
#include "recordings/bag/bag_output.hpp"
#include "recordings/mcap/mcap_record_builder.hpp"
#include "recordings/messages/message_definition.hpp"
#include "recordings/messages/quality_of_service.hpp"

namespace aims {
namespace {

constexpr std::size_t kMaxChunkBytes = std::size_t{1} << 30;
constexpr std::size_t kMaxMessageBytes = std::size_t{1} << 30;
constexpr std::string_view kLibrary = "aims";

/// A topic, and what the file holds of it.
struct TopicState {
  std::uint16_t schema = 0;
  std::vector<std::byte> records;  ///< schema, where it is new, and channel
  bool in_file = false;
  std::uint32_t sequence = 0;    ///< of the next message
  std::vector<std::byte> index;  ///< entries of the open chunk
  std::uint64_t messages = 0;
};

/// The records of one kind in the summary.
struct SummaryGroup {
  McapOp op;
  const std::vector<std::byte>& records;
};

std::vector<std::byte> first_bytes() {
  const auto magic = bytes_of(kMcapMagic);
  std::vector<std::byte> bytes(magic.begin(), magic.end());
  McapRecordBuilder(bytes, McapOp::kHeader).text("ros2").text(kLibrary).finish();
  return bytes;
}

/// Its name in MCAP, where no compression has none.
std::string_view mcap_name_of(BagCompression compression) {
  return compression == BagCompression::kNone ? std::string_view() : name_of(compression);
}

}  // namespace

struct McapWriter::Impl {
  std::filesystem::path file;
  BagWriterOptions options;
  std::unique_ptr<BagOutput> output;
  std::uint64_t position = 0;  ///< end of the file
  Crc32 crc = {};              ///< of the file up to there
  std::vector<TopicState> topics = {};
  std::map<std::string, std::uint16_t> schema_ids = {};  ///< by name and text
  std::vector<std::byte> schemas = {}, channels = {}, chunk_indexes = {};
  std::uint32_t chunks = 0;
  std::vector<std::byte> chunk = {};  ///< records of the open chunk
  std::optional<std::pair<Time, Time>> chunk_span = {}, span = {};
  bool closed = false;
  std::optional<Error> broken = {};  ///< the first error, returned by every later call

  Result<void> append_to_file(std::span<const std::byte> bytes);
  /// Moves the message indexes of the open chunk to `out`; returns their positions, by channel,
  /// when `out` is written at `start`.
  std::vector<std::byte> take_indexes(std::uint64_t start, std::vector<std::byte>& out);
  Result<void> close_chunk();
  Result<void> close_file();
  std::vector<std::byte> statistics() const;
  tl::unexpected<Error> refuse(const std::string& why) const {
    return failure(fmt::format("{}: {}", file.string(), why));
  }
};

Result<void> McapWriter::Impl::append_to_file(std::span<const std::byte> bytes) {
  if (auto written = output->write_at(position, bytes); !written) return written;
  position += bytes.size();
  crc.add(bytes);
  return {};
}

std::vector<std::byte> McapWriter::Impl::take_indexes(std::uint64_t start,
                                                      std::vector<std::byte>& out) {
  std::vector<std::byte> positions;
  for (std::uint16_t id = 0; id < topics.size(); ++id) {
    TopicState& topic = topics[id];
    if (topic.index.empty()) continue;
    append_number(positions, id);
    append_number(positions, start + out.size());
    McapRecordBuilder(out, McapOp::kMessageIndex).number(id).entries(topic.index).finish();
    topic.index.clear();
  }
  return positions;
}

Result<void> McapWriter::Impl::close_chunk() {
  if (!chunk_span) return {};
  const auto packed = compress(options.compression, chunk);
  if (!packed) return refuse(packed.error().message);
  const auto start = static_cast<std::uint64_t>(chunk_span->first);
  const auto end = static_cast<std::uint64_t>(chunk_span->second);
  const std::string_view compression = mcap_name_of(options.compression);
  std::vector<std::byte> bytes;
  McapRecordBuilder(bytes, McapOp::kChunk)
      .number(start)
      .number(end)
      .number(std::uint64_t{chunk.size()})
      .number(crc32_of(chunk))
      .text(compression)
      .number(std::uint64_t{packed->size()})
      .bytes(*packed)
      .finish();
  const std::uint64_t length = bytes.size();
  const std::vector<std::byte> indexes = take_indexes(position, bytes);
  McapRecordBuilder(chunk_indexes, McapOp::kChunkIndex)
      .number(start)
      .number(end)
      .number(position)
      .number(length)
      .entries(indexes)
      .number(bytes.size() - length)
      .text(compression)
      .number(std::uint64_t{packed->size()})
      .number(std::uint64_t{chunk.size()})
      .finish();
  ++chunks;
  chunk.clear();
  chunk_span.reset();
  return append_to_file(bytes);
}

std::vector<std::byte> McapWriter::Impl::statistics() const {
  std::vector<std::byte> counts;
  std::uint64_t messages = 0;
  for (std::uint16_t id = 0; id < topics.size(); ++id) {
    if (topics[id].messages == 0) continue;
    append_number(counts, id);
    append_number(counts, topics[id].messages);
    messages += topics[id].messages;
  }
  const auto [start, end] = span.value_or(std::pair<Time, Time>(0, 0));
  std::vector<std::byte> record;
  McapRecordBuilder(record, McapOp::kStatistics)
      .number(messages)
      .number(static_cast<std::uint16_t>(schema_ids.size()))
      .number(static_cast<std::uint32_t>(topics.size()))
      .number(std::uint32_t{0})  // attachments
      .number(std::uint32_t{0})  // metadata
      .number(chunks)
      .number(static_cast<std::uint64_t>(start))
      .number(static_cast<std::uint64_t>(end))
      .entries(counts)
      .finish();
  return record;
}

Result<void> McapWriter::Impl::close_file() {
  if (auto written = close_chunk(); !written) return written;
  std::vector<std::byte> end_of_data;
  McapRecordBuilder(end_of_data, McapOp::kDataEnd).number(crc.value()).finish();
  if (auto written = append_to_file(end_of_data); !written) return written;

  const std::vector<std::byte> counts = statistics();
  const std::uint64_t start = position;
  std::vector<std::byte> summary, offsets;
  for (const SummaryGroup& group :
       {SummaryGroup{McapOp::kSchema, schemas}, SummaryGroup{McapOp::kChannel, channels},
        SummaryGroup{McapOp::kChunkIndex, chunk_indexes},
        SummaryGroup{McapOp::kStatistics, counts}}) {
    if (group.records.empty()) continue;
    McapRecordBuilder(offsets, McapOp::kSummaryOffset)
        .number(static_cast<std::uint8_t>(group.op))
        .number(start + summary.size())
        .number(std::uint64_t{group.records.size()})
        .finish();
    append(summary, group.records);
  }
  const std::uint64_t offsets_start = start + summary.size();
  append(summary, offsets);
  // The checksum covers the summary and the footer up to itself.
  append_number(summary, static_cast<std::uint8_t>(McapOp::kFooter));
  append_number(summary, kMcapFooterSize);
  append_number(summary, start);
  append_number(summary, offsets_start);
  append_number(summary, crc32_of(summary));
  append(summary, bytes_of(kMcapMagic));
  if (auto written = append_to_file(summary); !written) return written;
  return output->close();
}

McapWriter::McapWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
McapWriter::McapWriter(McapWriter&&) noexcept = default;

McapWriter& McapWriter::operator=(McapWriter&& other) noexcept {
  std::swap(impl_, other.impl_);
  return *this;
}

McapWriter::~McapWriter() {
  if (impl_) static_cast<void>(close());
}

Result<McapWriter> McapWriter::create(const std::filesystem::path& file, BagWriterOptions options) {
  options.chunk_size = std::clamp<std::size_t>(options.chunk_size, 1, kMaxChunkBytes);
  if (options.compression == BagCompression::kBz2) {
    return failure(fmt::format("{}: compression bz2: expected none, lz4 or zstd for an MCAP file",
                               file.string()));
  }
  const std::vector<std::byte> first = first_bytes();
  auto output = create_bag_output(file, first);
  if (!output) return tl::unexpected(output.error());
  auto impl = std::unique_ptr<Impl>(new Impl{file, options, std::move(*output)});
  impl->position = first.size();
  impl->crc.add(first);
  return McapWriter(std::move(impl));
}

std::uint32_t McapWriter::add_connection(const std::string& topic, const MessageType& type,
                                         bool latching) {
  Impl& mcap = *impl_;
  const auto id = static_cast<std::uint16_t>(mcap.topics.size());
  TopicState state;
  const auto next_schema = static_cast<std::uint16_t>(mcap.schema_ids.size() + 1);
  const auto [schema, added] =
      mcap.schema_ids.emplace(type.name + '\n' + type.definition, next_schema);
  state.schema = schema->second;
  if (added) {
    const bool idl = type.format.language == DefinitionLanguage::kRos2Idl;
    McapRecordBuilder(state.records, McapOp::kSchema)
        .number(state.schema)
        .text(ros2_type_name(type.name))
        .text(idl ? "ros2idl" : "ros2msg")
        .text(type.definition)
        .finish();
    append(mcap.schemas, state.records);
  }
  std::vector<std::byte> metadata, channel;
  for (const std::string& text : {std::string("offered_qos_profiles"), offered_quality(latching)}) {
    append_number(metadata, static_cast<std::uint32_t>(text.size()));
    append(metadata, bytes_of(text));
  }
  McapRecordBuilder(channel, McapOp::kChannel)
      .number(id)
      .number(state.schema)
      .text(topic)
      .text("cdr")
      .entries(metadata)
      .finish();
  append(mcap.channels, channel);
  append(state.records, channel);
  mcap.topics.push_back(std::move(state));
  return id;
}

Result<void> McapWriter::write(std::uint32_t connection, Time record_time,
                               std::span<const std::byte> data) {
  Impl& mcap = *impl_;
  if (mcap.broken) return tl::unexpected(*mcap.broken);
  if (mcap.closed) return mcap.refuse("is closed: nothing can be written");
  if (connection >= mcap.topics.size()) {
    return mcap.refuse(fmt::format("has no connection {}", connection));
  }
  if (record_time < 0) {
    return mcap.refuse(fmt::format("expected a record time >= 0, found {} ns", record_time));
  }
  if (data.size() > kMaxMessageBytes) {
    return mcap.refuse(fmt::format("a message of {} bytes is too large", data.size()));
  }
  // A schema may be used by an earlier topic that has no message yet: all are written before it.
  for (std::size_t i = 0; i <= connection; ++i) {
    TopicState& each = mcap.topics[i];
    if (!std::exchange(each.in_file, true)) append(mcap.chunk, each.records);
  }
  TopicState& topic = mcap.topics[connection];
  const auto time = static_cast<std::uint64_t>(record_time);
  append_number(topic.index, time);
  append_number(topic.index, std::uint64_t{mcap.chunk.size()});
  McapRecordBuilder(mcap.chunk, McapOp::kMessage)
      .number(static_cast<std::uint16_t>(connection))
      .number(topic.sequence++)
      .number(time)
      .number(time)
      .bytes(data)
      .finish();
  ++topic.messages;
  for (auto* span : {&mcap.chunk_span, &mcap.span}) {
    const auto known = span->value_or(std::pair(record_time, record_time));
    *span = {std::min(known.first, record_time), std::max(known.second, record_time)};
  }
  if (mcap.chunk.size() < mcap.options.chunk_size) return {};
  auto closed = mcap.close_chunk();
  if (!closed) mcap.broken = closed.error();
  return closed;
}

Result<void> McapWriter::close() {
  Impl& mcap = *impl_;
  if (mcap.broken) return tl::unexpected(*mcap.broken);
  if (mcap.closed) return {};
  mcap.closed = true;
  auto outcome = mcap.close_file();
  if (!outcome) mcap.broken = outcome.error();
  return outcome;
}

}  // namespace aims
