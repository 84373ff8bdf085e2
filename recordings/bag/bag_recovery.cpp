// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/bag/bag_index.hpp"

#include <algorithm>

namespace aims {
namespace {

/// Fills in times and counts of a chunk from its content; false when it is damaged.
bool read_chunk(const BagFile& file, std::size_t memory_limit, BagIndex& index, ChunkPlace& place,
                ChunkContent& content) {
  if (place.memory() > memory_limit) return false;
  // Connections of a damaged chunk are discarded.
  BagConnections connections = index.connections;
  if (!load_chunk(file, place, connections, content)) return false;
  index.connections = std::move(connections);
  count_messages(content, place);
  return true;
}

/// Appends the chunks found from `position` on; returns where scanning ends.
std::uint64_t scan_chunks(const BagFile& file, std::uint64_t position,
                          std::vector<ChunkPlace>& chunks) {
  std::uint64_t end = position;
  while (true) {
    const auto record = file.record(position);
    if (!record || record->op == BagOp::kMessage || record->op == BagOp::kFileHeader) return end;
    position = record->end();
    if (record->op == BagOp::kChunk) {
      auto place = chunk_place(file, *record);
      // rosbag writes the size of a chunk only when it closes it.
      if (!place || place->size == 0) return end;
      chunks.push_back(std::move(*place));
    }
    end = position;
  }
}

}  // namespace

bool has_intact_chunk(const BagFile& file, std::uint64_t position, std::size_t memory_limit) {
  std::vector<ChunkPlace> candidates;
  scan_chunks(file, position, candidates);
  BagIndex index;
  ChunkContent content;
  return std::ranges::any_of(candidates, [&](ChunkPlace& place) {
    return read_chunk(file, memory_limit, index, place, content) && !place.counts.empty();
  });
}

Result<BagIndex> recover_index(const BagFile& file, std::size_t memory_limit) {
  auto known = read_index(file, memory_limit);
  BagIndex index;
  std::vector<ChunkPlace> candidates;
  if (known) {
    index.connections = std::move(known->connections);
    candidates = std::move(known->chunks);
  } else {
    const auto header = read_file_header(file);
    if (!header) return tl::unexpected(header.error());
    index.indexed = false;
    index.lost_bytes = file.size() - scan_chunks(file, header->end(), candidates);
  }
  index.connections.reset_counts();
  ChunkContent content;
  for (ChunkPlace& place : candidates) {
    if (!read_chunk(file, memory_limit, index, place, content)) {
      index.lost_bytes += place.packed_size;
    } else if (!place.counts.empty()) {
      index.chunks.push_back(std::move(place));
    }
  }
  for (const ChunkPlace& place : index.chunks) {
    for (const auto& [id, count] : place.counts) index.connections.find(id)->messages += count;
  }
  return index;
}

}  // namespace aims
