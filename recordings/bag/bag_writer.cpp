// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/bag/bag_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "recordings/bag/bag_publisher.hpp"
#include "recordings/bag/bag_records.hpp"

namespace aims {
namespace {

constexpr std::size_t kMaxChunkBytes = std::size_t{1} << 30;
constexpr std::size_t kMaxMessageBytes = std::size_t{1} << 30;
constexpr Time kEndOfTime = static_cast<Time>(std::numeric_limits<std::uint32_t>::max()) * kSecond;

/// Bytes of a connection and its count in a chunk's info.
constexpr std::size_t kCountSize = 8;

struct Connection {
  std::vector<std::byte> record;
  bool in_file = false;          ///< its record is in a chunk already
  std::vector<std::byte> index;  ///< entries of the open chunk
};

std::vector<std::byte> connection_record(std::uint32_t id, const std::string& topic,
                                         const MessageType& type, bool latching) {
  std::vector<std::byte> record;
  HeaderBuilder(record).number("conn", id).op(BagOp::kConnection).text("topic", topic).finish();
  HeaderBuilder data(record);
  if (latching) data.text("latching", "1");
  data.text("md5sum", type.md5).text("message_definition", type.definition);
  data.text("topic", topic).text("type", type.name).finish();
  return record;
}

}  // namespace

struct BagWriter::Impl {
  std::filesystem::path file;
  BagWriterOptions options;
  BagPublisher publisher;
  std::vector<Connection> connections;
  BagIndexBytes index;
  std::vector<std::byte> chunk;         ///< content of the open chunk
  std::vector<std::byte> chunk_record;  ///< of the last chunk; kept, since new memory costs time
  Time start = 0;
  Time end = 0;
  bool has_messages = false;
  bool closed = false;
  std::optional<Error> broken;  ///< the first error, returned by every later call

  Result<void> close_chunk();
  Result<void> close_file();
  /// Moves the index records of the open chunk to `out`; returns the message counts by connection.
  std::vector<std::byte> take_index(std::vector<std::byte>& out);
  tl::unexpected<Error> refuse(const std::string& why) const {
    return failure(fmt::format("{}: {}", file.string(), why));
  }
};

std::vector<std::byte> BagWriter::Impl::take_index(std::vector<std::byte>& out) {
  std::vector<std::byte> counts;
  for (std::uint32_t id = 0; id < connections.size(); ++id) {
    std::vector<std::byte>& entries = connections[id].index;
    if (entries.empty()) continue;
    const auto count = static_cast<std::uint32_t>(entries.size() / kIndexEntrySize);
    HeaderBuilder(out)
        .number("conn", id)
        .number("count", count)
        .op(BagOp::kIndex)
        .number("ver", std::uint32_t{1})
        .finish();
    append_data(out, entries);
    append_number(counts, id);
    append_number(counts, count);
    entries.clear();
  }
  return counts;
}

Result<void> BagWriter::Impl::close_chunk() {
  if (!has_messages) return {};
  const bool plain = options.compression == BagCompression::kNone;
  const auto packed = plain ? std::vector<std::byte>() : compress(options.compression, chunk);
  if (!packed) return refuse(packed.error().message);
  std::vector<std::byte>& bytes = chunk_record;
  bytes.clear();
  HeaderBuilder(bytes)
      .text("compression", name_of(options.compression))
      .op(BagOp::kChunk)
      .number("size", static_cast<std::uint32_t>(chunk.size()))
      .finish();
  append_data(bytes, plain ? chunk : *packed);
  const std::vector<std::byte> counts = take_index(bytes);
  HeaderBuilder(index.chunk_infos)
      .number("chunk_pos", publisher.chunk_position())
      .number("count", static_cast<std::uint32_t>(counts.size() / kCountSize))
      .time("end_time", end)
      .op(BagOp::kChunkInfo)
      .time("start_time", start)
      .number("ver", std::uint32_t{1})
      .finish();
  append_data(index.chunk_infos, counts);
  ++index.chunk_count;
  chunk.clear();
  has_messages = false;
  return publisher.add_chunk(bytes, index);
}

Result<void> BagWriter::Impl::close_file() {
  if (auto written = close_chunk(); !written) return written;
  return publisher.finish(index);
}

BagWriter::BagWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BagWriter::BagWriter(BagWriter&&) noexcept = default;

BagWriter& BagWriter::operator=(BagWriter&& other) noexcept {
  std::swap(impl_, other.impl_);
  return *this;
}

BagWriter::~BagWriter() {
  if (impl_) static_cast<void>(close());
}

Result<BagWriter> BagWriter::create(const std::filesystem::path& file, BagWriterOptions options) {
  if (options.compression == BagCompression::kZstd) {
    return failure(fmt::format("{}: compression zstd: expected none, lz4 or bz2 for a ROS 1 bag",
                               file.string()));
  }
  auto output = create_bag_output(file, BagPublisher::empty_bag());
  if (!output) return tl::unexpected(output.error());
  return create(std::move(*output), file.string(), options);
}

Result<BagWriter> BagWriter::create(std::unique_ptr<BagOutput> output, const std::string& name,
                                    BagWriterOptions options) {
  options.chunk_size = std::clamp<std::size_t>(options.chunk_size, 1, kMaxChunkBytes);
  const std::uint64_t room = options.chunk_size + options.chunk_size / 4 + (1 << 12);
  auto impl = std::unique_ptr<Impl>(new Impl{name,
                                             options,
                                             BagPublisher(std::move(output), room),
                                             {},
                                             {},
                                             {},
                                             {},
                                             0,
                                             0,
                                             false,
                                             false,
                                             std::nullopt});
  return BagWriter(std::move(impl));
}

std::uint32_t BagWriter::add_connection(const std::string& topic, const MessageType& type,
                                        bool latching) {
  const auto id = static_cast<std::uint32_t>(impl_->connections.size());
  impl_->connections.push_back({connection_record(id, topic, type, latching), false, {}});
  append(impl_->index.connections, impl_->connections.back().record);
  ++impl_->index.connection_count;
  return id;
}

Result<void> BagWriter::write(std::uint32_t connection, Time record_time,
                              std::span<const std::byte> data) {
  Impl& bag = *impl_;
  if (bag.broken) return tl::unexpected(*bag.broken);
  if (bag.closed) return bag.refuse("is closed: nothing can be written");
  if (connection >= bag.connections.size()) {
    return bag.refuse(fmt::format("has no connection {}", connection));
  }
  if (record_time <= 0 || record_time >= kEndOfTime) {
    return bag.refuse(
        fmt::format("expected a record time above 0 and below 2^32 s, found {} ns", record_time));
  }
  if (data.size() > kMaxMessageBytes) {
    return bag.refuse(fmt::format("a message of {} bytes is too large", data.size()));
  }
  Connection& to = bag.connections[connection];
  if (!to.in_file) append(bag.chunk, to.record);
  to.in_file = true;
  append_time(to.index, record_time);
  append_number(to.index, static_cast<std::uint32_t>(bag.chunk.size()));
  HeaderBuilder(bag.chunk)
      .number("conn", connection)
      .op(BagOp::kMessage)
      .time("time", record_time)
      .finish();
  append_data(bag.chunk, data);
  bag.start = bag.has_messages ? std::min(bag.start, record_time) : record_time;
  bag.end = bag.has_messages ? std::max(bag.end, record_time) : record_time;
  bag.has_messages = true;
  if (bag.chunk.size() < bag.options.chunk_size) return {};
  auto closed = bag.close_chunk();
  if (!closed) bag.broken = closed.error();
  return closed;
}

Result<void> BagWriter::close() {
  Impl& bag = *impl_;
  if (bag.broken) return tl::unexpected(*bag.broken);
  if (bag.closed) return {};
  bag.closed = true;
  auto outcome = bag.close_file();
  if (!outcome) bag.broken = outcome.error();
  return outcome;
}

}  // namespace aims
