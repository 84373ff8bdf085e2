// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/bag/bag_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace aims {
namespace {

constexpr std::size_t kMaxConnectionBytes = std::size_t{16} << 20;
constexpr std::size_t kMaxChunkInfoBytes = std::size_t{16} << 20;

/// Printable form of bytes, for errors.
std::string shown(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c >= ' ' && c <= '~') {
      out += c;
    } else {
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
  }
  return out;
}

Result<void> check_magic(const BagFile& file) {
  std::vector<std::byte> bytes(std::min<std::uint64_t>(kBagMagic.size(), file.size()));
  if (auto got = file.read(0, bytes); !got) return got;
  const std::string_view magic = as_text(bytes);
  if (magic == kBagMagic) return {};
  if (magic.empty()) return file.refuse(0, "expected a ROS 1 bag, found an empty file");
  if (magic.starts_with("#ROSBAG V1") || magic.starts_with("#ROSRECORD V")) {
    return file.refuse(0, fmt::format("expected a bag of version 2.0, found '{}'; `rosbag filter "
                                      "OLD NEW True` makes one",
                                      shown(magic.substr(0, magic.find('\n')))));
  }
  const bool mcap = magic.starts_with("\x89MCAP");
  const bool sqlite = magic.starts_with("SQLite");
  return file.refuse(
      0, fmt::format("expected a ROS 1 bag ('#ROSBAG V2.0'), found '{}'{}", shown(magic),
                     mcap ? ", an MCAP file" : (sqlite ? ", perhaps a ROS 2 bag" : "")));
}

Result<void> read_connection(const BagFile& file, std::uint64_t& position, BagIndex& index) {
  const auto record = file.record(position);
  if (!record) return tl::unexpected(record.error());
  if (record->op != BagOp::kConnection) {
    return file.refuse(
        position, fmt::format("expected a connection in the index, found {}", name_of(record->op)));
  }
  const auto data = file.data(*record, kMaxConnectionBytes);
  if (!data) return tl::unexpected(data.error());
  const auto added = index.connections.add(record->header, *data);
  if (!added) return file.refuse(position, added.error().message);
  position = record->end();
  return {};
}

/// Reads the messages per connection from a chunk info.
Result<void> read_counts(const BagFile& file, const FileRecord& record, BagIndex& index,
                         ChunkPlace& place) {
  const auto data = file.data(record, kMaxChunkInfoBytes);
  if (!data) return tl::unexpected(data.error());
  const auto count = record.header.number<std::uint32_t>("count");
  if (!count || data->size() != 8 * std::uint64_t{*count}) {
    return file.refuse(record.position,
                       fmt::format("expected a chunk's info with 8 bytes for each of its {} "
                                   "connections, found {}",
                                   count.value_or(0), data->size()));
  }
  place.index_records = *count;
  for (std::size_t at = 0; at < data->size(); at += 8) {
    const auto id = load_number<std::uint32_t>(data->data() + at);
    BagConnection* connection = index.connections.find(id);
    if (connection == nullptr || place.counts.contains(id)) {
      return file.refuse(record.data_position + at,
                         fmt::format("a chunk's info names connection {} {}", id,
                                     connection ? "twice" : "which no record announces"));
    }
    const auto messages = load_number<std::uint32_t>(data->data() + at + 4);
    if (messages > 0) place.counts[id] = messages;
    connection->messages += messages;
  }
  return {};
}

Result<void> read_chunk_info(const BagFile& file, std::uint64_t& position, BagIndex& index) {
  const auto record = file.record(position);
  if (!record) return tl::unexpected(record.error());
  const auto version = record->header.number<std::uint32_t>("ver");
  const auto chunk_position = record->header.number<std::uint64_t>("chunk_pos");
  const auto start = record->header.time("start_time");
  const auto end = record->header.time("end_time");
  if (record->op != BagOp::kChunkInfo || version != 1U || !chunk_position || !start || !end) {
    return file.refuse(position, fmt::format("expected a chunk's info of version 1 with position "
                                             "and times, found {}",
                                             name_of(record->op)));
  }
  const auto chunk = file.record(*chunk_position);
  if (!chunk) return tl::unexpected(chunk.error());
  auto place = chunk_place(file, *chunk);
  if (!place) return tl::unexpected(place.error());
  place->start = *start;
  place->end = *end;
  auto counted = read_counts(file, *record, index, *place);
  if (!counted) return counted;
  if (!place->counts.empty()) index.chunks.push_back(std::move(*place));
  position = record->end();
  return {};
}

/// Sorts the chunks by position. Error when two overlap.
Result<void> sort_chunks(const BagFile& file, BagIndex& index) {
  std::stable_sort(
      index.chunks.begin(), index.chunks.end(),
      [](const ChunkPlace& a, const ChunkPlace& b) { return a.position < b.position; });
  for (std::size_t i = 1; i < index.chunks.size(); ++i) {
    if (index.chunks[i].position < index.chunks[i - 1].end_position()) {
      return file.refuse(index.chunks[i].position,
                         fmt::format("the index has a chunk here, inside the one at byte {}",
                                     index.chunks[i - 1].position));
    }
  }
  return {};
}

/// The index that the file header points to, as far as it can be read.
Result<BagIndex> read_index_at(const BagFile& file, std::uint64_t position,
                               std::uint32_t connection_count, std::uint32_t chunk_count) {
  if (position > file.size() || (position == file.size() && connection_count > 0)) {
    return file.refuse(
        position, fmt::format("expected the index, but the file ends at byte {}", file.size()));
  }
  BagIndex index;
  for (std::uint32_t i = 0; i < connection_count; ++i) {
    const auto read = read_connection(file, position, index);
    if (!read) return tl::unexpected(read.error());
  }
  for (std::uint32_t i = 0; i < chunk_count; ++i) {
    const auto read = read_chunk_info(file, position, index);
    if (!read) return tl::unexpected(read.error());
  }
  if (const auto sorted = sort_chunks(file, index); !sorted) return tl::unexpected(sorted.error());
  return index;
}

}  // namespace

Result<FileRecord> read_file_header(const BagFile& file) {
  if (const auto magic = check_magic(file); !magic) return tl::unexpected(magic.error());
  auto header = file.record(kBagMagic.size());
  if (!header) return header;
  if (header->op != BagOp::kFileHeader) {
    return file.refuse(header->position,
                       fmt::format("expected the file header, found {}", name_of(header->op)));
  }
  const auto encryptor = header->header.text("encryptor");
  if (encryptor && !encryptor->empty()) {
    return file.refuse(header->position,
                       fmt::format("the bag is encrypted by {}; `rosbag decrypt` first",
                                   shown(encryptor->substr(0, 64))));
  }
  return header;
}

Result<BagIndex> read_index(const BagFile& file, std::size_t memory_limit) {
  const auto header = read_file_header(file);
  if (!header) return tl::unexpected(header.error());
  const auto index_position = header->header.number<std::uint64_t>("index_pos");
  const auto connection_count = header->header.number<std::uint32_t>("conn_count");
  const auto chunk_count = header->header.number<std::uint32_t>("chunk_count");
  if (!index_position || !connection_count || !chunk_count) {
    return file.refuse(header->position,
                       "expected 'index_pos', 'conn_count' and 'chunk_count' in the file header");
  }
  Result<BagIndex> index =
      *index_position == 0
          ? file.refuse(header->position, "the bag was never closed and has no index")
          : read_index_at(file, *index_position, *connection_count, *chunk_count);
  if (index) return index;
  const std::string& broken = index.error().message;
  if (!has_intact_chunk(file, header->end(), memory_limit)) {
    return failure(broken + "; no chunk of it is intact");
  }
  return failure(broken + "; --recover reads the intact chunks, `rosbag reindex` repairs it",
                 ErrorKind::kRecoverable);
}

}  // namespace aims
