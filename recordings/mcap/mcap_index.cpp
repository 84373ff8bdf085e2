// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/mcap/mcap_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "core/files/crc32.hpp"
#include "core/text.hpp"
#include "recordings/mcap/mcap_scan.hpp"

namespace aims {
namespace {

/// The records of the summary that are used.
struct Summary {
  McapDefinitions definitions;
  std::vector<McapChunkIndex> chunks;
  std::optional<McapStatistics> statistics;
  std::uint64_t position = 0;  ///< where the data section ends at the latest
};

/// Error unless the file begins with the magic bytes and a header.
Result<McapPlace> read_header(const BagFile& file) {
  std::vector<std::byte> bytes(std::min<std::uint64_t>(kMcapMagic.size(), file.size()));
  if (auto got = file.read(0, bytes); !got) return tl::unexpected(got.error());
  if (as_text(bytes) != kMcapMagic) {
    return file.refuse(0, fmt::format("expected an MCAP file of version 0, found '{}'",
                                      line_text(as_text(bytes))));
  }
  auto header = mcap_place(file, kMcapMagic.size());
  if (header && header->op != McapOp::kHeader) {
    return file.refuse(header->position,
                       fmt::format("expected the header, found {}", name_of(header->op)));
  }
  return header;
}

Result<McapFooter> read_footer(const BagFile& file, std::uint64_t& position) {
  constexpr std::uint64_t kEnd = kMcapPrefix + kMcapFooterSize + kMcapMagic.size();
  const std::uint64_t least = kMcapMagic.size() + kMcapPrefix + kEnd;
  const auto unclosed = [&] {
    return file.refuse(file.size(),
                       "expected a footer and the magic bytes before the end of the "
                       "file: it was never closed or is truncated");
  };
  if (file.size() < least) return unclosed();
  position = file.size() - kEnd;
  std::vector<std::byte> bytes(kEnd);
  if (auto got = file.read(position, bytes); !got) return tl::unexpected(got.error());
  ByteCursor cursor(bytes);
  const auto record = read_mcap_record(cursor);
  if (!record || record->op != McapOp::kFooter) return unclosed();
  const auto footer = parse_footer(record->body);
  const auto magic = cursor.take(kMcapMagic.size());
  if (!footer || !magic || as_text(*magic) != kMcapMagic) return unclosed();
  return *footer;
}

Result<void> add_record(const McapRecord& record, Summary& summary) {
  if (record.op == McapOp::kChunkIndex) {
    auto index = parse_chunk_index(record.body);
    if (!index) return failure("expected a chunk index with position, channels and sizes");
    summary.chunks.push_back(std::move(*index));
  } else if (record.op == McapOp::kStatistics) {
    summary.statistics = parse_statistics(record.body);
    if (!summary.statistics) return failure("expected statistics with message counts");
  }
  return summary.definitions.add(record);
}

/// The summary between its position and that of the footer.
Result<Summary> read_summary(const BagFile& file, const McapFooter& footer, std::uint64_t end,
                             std::size_t memory_limit) {
  Summary summary;
  summary.position = footer.summary == 0 ? end : footer.summary;
  if (footer.summary == 0) return summary;
  if (footer.summary > end || end - footer.summary > memory_limit) {
    return file.refuse(end, fmt::format("expected a summary before byte {} and of at most {} "
                                        "bytes, found one at byte {}",
                                        end, memory_limit, footer.summary));
  }
  // The checksum covers the summary and the footer up to itself.
  std::vector<std::byte> bytes(end - footer.summary + kMcapPrefix + kMcapFooterSize -
                               sizeof(std::uint32_t));
  if (auto got = file.read(footer.summary, bytes); !got) return tl::unexpected(got.error());
  if (footer.crc != 0 && crc32_of(bytes) != footer.crc) {
    return file.refuse(footer.summary, fmt::format("expected a summary with checksum {:08x}, "
                                                   "found {:08x}",
                                                   footer.crc, crc32_of(bytes)));
  }
  const std::span<const std::byte> records = bytes;
  ByteCursor cursor(records.first(end - footer.summary));
  while (cursor.left() > 0) {
    const std::uint64_t position = footer.summary + cursor.position();
    const auto record = read_mcap_record(cursor);
    if (!record) return file.refuse(position, record.error().message);
    const auto added = add_record(*record, summary);
    if (!added) return file.refuse(position, added.error().message);
  }
  return summary;
}

/// Whether the summary lists all chunks, and announces every channel that has messages.
bool is_complete(const Summary& summary) {
  if (!summary.statistics || summary.statistics->chunks != summary.chunks.size()) return false;
  std::uint64_t messages = 0;
  for (const auto& [channel, count] : summary.statistics->counts) {
    if (!summary.definitions.contains(channel)) return false;
    messages += count;
  }
  return messages == summary.statistics->messages;
}

Result<void> add_message(const McapRecord& record, std::size_t offset,
                         const McapDefinitions& definitions, ChunkContent& content,
                         std::uint64_t* lost_messages) {
  const auto message = parse_message(record.body);
  if (!message) return failure("expected a message with channel and times");
  if (!definitions.contains(message->channel)) {
    return failure(
        fmt::format("a message of channel {}, which no record announces", message->channel));
  }
  if (message->log_time > static_cast<std::uint64_t>(std::numeric_limits<Time>::max())) {
    if (lost_messages != nullptr) return ++*lost_messages, Result<void>();
    return failure(fmt::format("expected a log time below 2^63 ns, found {}", message->log_time));
  }
  const auto data_offset = static_cast<std::uint32_t>(message->data.data() - content.bytes.data());
  content.messages.push_back({static_cast<Time>(message->log_time), message->channel,
                              static_cast<std::uint32_t>(offset), data_offset,
                              static_cast<std::uint32_t>(message->data.size())});
  return {};
}

Result<void> find_messages(McapDefinitions& definitions, ChunkContent& content, std::size_t& offset,
                           std::uint64_t* lost_messages) {
  content.messages.clear();
  ByteCursor cursor(content.bytes);
  while (cursor.left() > 0) {
    offset = cursor.position();
    const auto record = read_mcap_record(cursor);
    if (!record) return tl::unexpected(record.error());
    const bool message = record->op == McapOp::kMessage;
    const auto added = message ? add_message(*record, offset, definitions, content, lost_messages)
                               : definitions.add(*record);
    if (!added) return added;
  }
  return {};
}

void add_counts(const ChunkPlace& place, McapIndex& index) {
  for (const auto& [channel, count] : place.counts) {
    index.counts[channel] += count;
    index.messages += count;
  }
}

/// Reads a chunk to learn its times and counts. Definitions of a damaged chunk are discarded.
Result<void> survey_chunk(const BagFile& file, std::size_t memory_limit, ChunkContent& content,
                          ChunkPlace place, McapIndex& index, bool recover = false) {
  if (place.memory() > memory_limit) {
    return file.refuse(place.position,
                       fmt::format("this chunk needs {} bytes of memory, more than {}",
                                   place.memory(), memory_limit));
  }
  McapDefinitions definitions = index.definitions;
  std::uint64_t lost = 0;
  auto got = load_mcap_chunk(file, place, definitions, content, recover ? &lost : nullptr);
  if (!got) return got;
  index.lost_messages += lost;
  index.definitions = std::move(definitions);
  count_messages(content, place);
  add_counts(place, index);
  if (!place.counts.empty()) index.chunks.push_back(std::move(place));
  return {};
}

/// The chunks that the summary lists, with the channels of each.
Result<std::vector<ChunkPlace>> listed_chunks(const BagFile& file, const Summary& summary,
                                              std::vector<std::uint64_t>& ends) {
  std::vector<McapChunkIndex> sorted = summary.chunks;
  std::ranges::stable_sort(sorted, {}, &McapChunkIndex::position);
  std::vector<ChunkPlace> chunks;
  for (const McapChunkIndex& each : sorted) {
    const auto record = mcap_place(file, each.position);
    if (!record) return tl::unexpected(record.error());
    auto chunk = mcap_chunk_place(file, *record);
    if (!chunk) return tl::unexpected(chunk.error());
    const std::uint64_t end = record->end() + each.index_length;
    if (record->end() - each.position != each.length || end < record->end() ||
        end > summary.position || (!ends.empty() && each.position < ends.back())) {
      return file.refuse(each.position,
                         fmt::format("the summary has a chunk of {} bytes and {} bytes of message "
                                     "indexes here, which do not fit",
                                     each.length, each.index_length));
    }
    for (const std::uint16_t channel : each.channels) chunk->counts[channel] = 1;
    ends.push_back(end);
    chunks.push_back(std::move(*chunk));
  }
  return chunks;
}

/// The index from the summary, completed by records that lie outside chunks.
Result<McapIndex> index_of(const BagFile& file, std::uint64_t data, Summary summary,
                           std::size_t memory_limit) {
  std::vector<std::uint64_t> ends;
  auto chunks = listed_chunks(file, summary, ends);
  if (!chunks) return tl::unexpected(chunks.error());
  McapIndex index;
  index.definitions = std::move(summary.definitions);
  ChunkContent content;
  std::uint64_t position = data;
  for (std::size_t i = 0; i <= chunks->size(); ++i) {
    const bool last = i == chunks->size();
    const McapScan gap = scan_mcap(file, position, last ? summary.position : (*chunks)[i].position);
    if (gap.broken) return tl::unexpected(*gap.broken);
    for (const ChunkPlace& each : gap.chunks) {
      if (each.data_position != each.position) {
        return file.refuse(each.position, "a chunk that the summary omits");
      }
      const auto read = survey_chunk(file, memory_limit, content, each, index);
      if (!read) return tl::unexpected(read.error());
    }
    if (last) break;
    index.chunks.push_back(std::move((*chunks)[i]));
    position = ends[i];
  }
  index.counts.clear();
  for (const auto& [channel, count] : summary.statistics->counts) index.counts[channel] = count;
  index.messages = summary.statistics->messages;
  return index;
}

/// What is read first of a file.
struct Opened {
  std::uint64_t data = 0;  ///< where the data section begins
  std::optional<Summary> summary;
  std::optional<Error> broken;  ///< why there is no summary
};

Result<Opened> open_mcap(const BagFile& file, std::size_t memory_limit) {
  const auto header = read_header(file);
  if (!header) return tl::unexpected(header.error());
  Opened opened;
  opened.data = header->end();
  std::uint64_t end = 0;
  const auto footer = read_footer(file, end);
  Result<Summary> summary =
      footer ? read_summary(file, *footer, end, memory_limit) : tl::unexpected(footer.error());
  if (summary) {
    opened.summary = std::move(*summary);
  } else {
    opened.broken = summary.error();
  }
  return opened;
}

/// By the summary, else by all chunks.
Result<McapIndex> read_opened(const BagFile& file, Opened opened, std::size_t memory_limit) {
  if (opened.broken) return tl::unexpected(*opened.broken);
  if (is_complete(*opened.summary)) {
    return index_of(file, opened.data, std::move(*opened.summary), memory_limit);
  }
  McapIndex index;
  index.indexed = false;
  const McapScan scan = scan_mcap(file, opened.data, opened.summary->position);
  if (scan.broken) return tl::unexpected(*scan.broken);
  ChunkContent content;
  for (const ChunkPlace& place : scan.chunks) {
    const auto read = survey_chunk(file, memory_limit, content, place, index);
    if (!read) return tl::unexpected(read.error());
  }
  return index;
}

/// Whether recovery would find a chunk.
bool has_intact_mcap_chunk(const BagFile& file, std::uint64_t data, std::size_t memory_limit) {
  const McapScan scan = scan_mcap(file, data, file.size(), true);
  McapIndex index;
  ChunkContent content;
  return std::ranges::any_of(scan.chunks, [&](const ChunkPlace& place) {
    return survey_chunk(file, memory_limit, content, place, index, true) && index.messages > 0;
  });
}

}  // namespace

Result<void> load_mcap_chunk(const BagFile& file, const ChunkPlace& place,
                             McapDefinitions& definitions, ChunkContent& content,
                             std::uint64_t* lost_messages) {
  if (auto got = unpack_chunk(file, place, content); !got) return got;
  if (place.crc != 0 && crc32_of(content.bytes) != place.crc) {
    return file.refuse(place.position,
                       fmt::format("expected a chunk with checksum {:08x}, found {:08x}", place.crc,
                                   crc32_of(content.bytes)));
  }
  std::size_t offset = 0;
  const auto found = find_messages(definitions, content, offset, lost_messages);
  if (!found) return refuse_in_chunk(file, place, offset, found.error().message);
  return {};
}

Result<McapIndex> read_mcap_index(const BagFile& file, std::size_t memory_limit) {
  auto opened = open_mcap(file, memory_limit);
  if (!opened) return tl::unexpected(opened.error());
  const std::uint64_t data = opened->data;
  auto index = read_opened(file, std::move(*opened), memory_limit);
  if (index) return index;
  const std::string& broken = index.error().message;
  if (!has_intact_mcap_chunk(file, data, memory_limit)) {
    return failure(broken + "; no chunk of it is intact");
  }
  return failure(broken + "; --recover reads the intact part", ErrorKind::kRecoverable);
}

Result<McapIndex> recover_mcap_index(const BagFile& file, std::size_t memory_limit) {
  auto opened = open_mcap(file, memory_limit);
  if (!opened) return tl::unexpected(opened.error());
  McapIndex index;
  std::vector<ChunkPlace> candidates;
  Result<McapIndex> known = failure("");
  if (opened->summary && is_complete(*opened->summary)) {
    known = index_of(file, opened->data, *opened->summary, memory_limit);
  }
  if (known) {
    index.definitions = std::move(known->definitions);
    candidates = std::move(known->chunks);
  } else {
    McapScan scan = scan_mcap(file, opened->data, file.size(), true);
    index.indexed = false;
    index.closed = opened->summary.has_value();
    if (scan.broken) index.lost_bytes = file.size() - scan.end;
    index.lost_bytes += scan.lost_bytes;
    candidates = std::move(scan.chunks);
  }
  ChunkContent content;
  for (const ChunkPlace& place : candidates) {
    if (!survey_chunk(file, memory_limit, content, place, index, true)) {
      index.lost_bytes += place.packed_size;
    }
  }
  return index;
}

}  // namespace aims
