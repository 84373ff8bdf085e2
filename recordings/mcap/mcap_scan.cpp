// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/mcap/mcap_scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace aims {
namespace {

/// A run of records outside chunks ends when it has this many bytes.
constexpr std::uint64_t kRunBytes = std::uint64_t{4} << 20;
/// The fields of a chunk in front of its records, with the name of its compression [bytes].
constexpr std::uint64_t kChunkFields = 128;
/// Of a file, searched at a time.
constexpr std::uint64_t kSearchBytes = std::uint64_t{1} << 20;
/// Largest ratios of unpacked to packed bytes.
constexpr std::uint64_t kMaxLz4Ratio = 256;

Result<BagCompression> compression_of(std::string_view name) {
  if (name.empty()) return BagCompression::kNone;
  const auto known = compression_named(name);
  if (known == BagCompression::kLz4 || known == BagCompression::kZstd) return *known;
  return failure(
      fmt::format("expected compression lz4, zstd or none, found '{}'", name.substr(0, 32)));
}

bool is_in_run(McapOp op) {
  return op == McapOp::kSchema || op == McapOp::kChannel || op == McapOp::kMessage;
}

/// Appends the record to the last run, or starts another.
void add_to_run(const McapPlace& record, std::vector<ChunkPlace>& chunks, bool& in_run) {
  if (!in_run || chunks.back().size > kRunBytes) {
    ChunkPlace run;
    run.position = run.data_position = record.position;
    chunks.push_back(run);
  }
  in_run = true;
  chunks.back().size = chunks.back().packed_size = record.end() - chunks.back().position;
}

/// Whether a chunk may begin at these bytes: its opcode, and a size that the file has room for.
bool may_be_chunk(const std::byte* bytes, std::uint64_t room) {
  if (std::to_integer<std::uint8_t>(*bytes) != static_cast<std::uint8_t>(McapOp::kChunk)) {
    return false;
  }
  const auto size = load_number<std::uint64_t>(bytes + 1);
  return size > 0 && size <= room;
}

/// Where the next chunk that states what can be begins, from `position` on; nothing without one.
std::optional<std::uint64_t> next_chunk(const BagFile& file, std::uint64_t position) {
  std::vector<std::byte> block(kSearchBytes);
  while (position + kMcapPrefix < file.size()) {
    block.resize(std::min<std::uint64_t>(kSearchBytes, file.size() - position));
    if (!file.read(position, block)) return std::nullopt;
    const std::uint64_t last = block.size() - kMcapPrefix;
    for (std::uint64_t i = 0; i <= last; ++i) {
      const std::uint64_t at = position + i;
      if (!may_be_chunk(block.data() + i, file.size() - at - kMcapPrefix)) continue;
      const auto record = mcap_place(file, at);
      if (record && mcap_chunk_place(file, *record)) return at;
    }
    position += last + 1;
  }
  return std::nullopt;
}

/// Goes on behind a damaged part, at the next chunk; false where there is none.
bool pass_damage(const BagFile& file, McapScan& scan, std::uint64_t end) {
  const auto found = next_chunk(file, scan.end + 1);
  if (!found || *found >= end) return false;
  scan.lost_bytes += *found - scan.end;
  scan.end = *found;
  return true;
}

}  // namespace

Result<McapPlace> mcap_place(const BagFile& file, std::uint64_t position) {
  std::vector<std::byte> prefix(kMcapPrefix);
  if (auto got = file.read(position, prefix); !got) return tl::unexpected(got.error());
  McapPlace place;
  place.op = static_cast<McapOp>(std::to_integer<std::uint8_t>(prefix[0]));
  place.position = position;
  place.size = load_number<std::uint64_t>(prefix.data() + 1);
  if (place.size <= file.size() - place.body()) return place;
  return file.refuse(position, fmt::format("expected {} bytes of {}, but the file ends at byte {}",
                                           place.size, name_of(place.op), file.size()));
}

Result<ChunkPlace> mcap_chunk_place(const BagFile& file, const McapPlace& record, bool recover) {
  if (record.op != McapOp::kChunk) {
    return file.refuse(record.position,
                       fmt::format("expected a chunk, found {}", name_of(record.op)));
  }
  std::vector<std::byte> bytes(std::min(record.size, kChunkFields));
  if (auto got = file.read(record.body(), bytes); !got) return tl::unexpected(got.error());
  const auto chunk = parse_chunk(bytes);
  if (!chunk || chunk->packed_size > record.size - chunk->header_size) {
    return file.refuse(record.position,
                       "expected a chunk with times, sizes, compression and "
                       "as many bytes of records as it states");
  }
  const auto compression = compression_of(chunk->compression);
  if (!compression) return file.refuse(record.position, compression.error().message);
  const bool none = *compression == BagCompression::kNone;
  const bool lz4 = *compression == BagCompression::kLz4;
  if (chunk->size > std::numeric_limits<std::uint32_t>::max() ||
      (none && chunk->size != chunk->packed_size) ||
      (lz4 && chunk->size > kMaxLz4Ratio * chunk->packed_size + kMaxLz4Ratio)) {
    return file.refuse(record.position,
                       fmt::format("a chunk of {} bytes cannot be packed into {} bytes ({})",
                                   chunk->size, chunk->packed_size, name_of(*compression)));
  }
  constexpr auto kLatest = static_cast<std::uint64_t>(std::numeric_limits<Time>::max());
  if (!recover && (chunk->start > kLatest || chunk->end > kLatest)) {
    return file.refuse(record.position, "expected a chunk with times below 2^63 ns");
  }
  ChunkPlace place;
  place.position = record.position;
  place.data_position = record.body() + chunk->header_size;
  place.packed_size = chunk->packed_size;
  place.size = chunk->size;
  place.compression = *compression;
  place.crc = chunk->crc;
  place.start = static_cast<Time>(std::min(chunk->start, kLatest));
  place.end = static_cast<Time>(std::min(chunk->end, kLatest));
  return place;
}

McapScan scan_mcap(const BagFile& file, std::uint64_t position, std::uint64_t end, bool recover) {
  McapScan scan;
  scan.end = position;
  bool in_run = false;
  while (scan.end < end) {
    const auto record = mcap_place(file, scan.end);
    const bool damaged = !record || record->op == static_cast<McapOp>(0);
    if (damaged && recover && pass_damage(file, scan, end)) {
      in_run = false;
      continue;
    }
    if (!record) {
      scan.broken = record.error();
      return scan;
    }
    if (record->op == McapOp::kDataEnd || record->op == McapOp::kFooter) return scan;
    if (record->op == McapOp::kChunk) {
      auto chunk = mcap_chunk_place(file, *record, recover);
      if (!chunk && recover) {
        scan.lost_bytes += record->size;
        scan.end = record->end();
        in_run = false;
        continue;
      }
      if (!chunk) {
        scan.broken = chunk.error();
        return scan;
      }
      scan.chunks.push_back(std::move(*chunk));
      in_run = false;
    } else if (is_in_run(record->op)) {
      add_to_run(*record, scan.chunks, in_run);
    } else if (record->op == static_cast<McapOp>(0)) {
      scan.broken = Error(file.refuse(scan.end, "expected a record, found opcode 0").value());
      return scan;
    } else {
      in_run = false;
    }
    scan.end = record->end();
  }
  return scan;
}

}  // namespace aims
