// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/error.hpp"
#include "recordings/bag/bag_chunk.hpp"
#include "recordings/bag/bag_file.hpp"

namespace aims {

/// Connections and chunks of a bag.
struct BagIndex {
  BagConnections connections;
  std::vector<ChunkPlace> chunks;  ///< in the order of the file; none is empty
  bool indexed = true;
  std::uint64_t lost_bytes = 0;
};

/// The first record of a bag; error when the file is no bag of version 2.0 or is encrypted.
Result<FileRecord> read_file_header(const BagFile& file);

/// Reads the index that the file header points to. The error of a damaged bag names what reads the
/// rest, where a chunk of it is intact.
Result<BagIndex> read_index(const BagFile& file, std::size_t memory_limit);

/// Whether recovery would find a chunk, from `position` on.
bool has_intact_chunk(const BagFile& file, std::uint64_t position, std::size_t memory_limit);

/// Reads all chunks and keeps the intact ones: those that the index lists or, without an index,
/// those found by scanning from the start. Chunks beyond `memory_limit` count as damaged.
Result<BagIndex> recover_index(const BagFile& file, std::size_t memory_limit);

}  // namespace aims
