// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/error.hpp"
#include "recordings/bag/bag_chunk.hpp"
#include "recordings/bag/bag_file.hpp"

namespace aims {

/// What is known of a bag before its messages are read.
struct BagIndex {
  BagConnections connections;
  std::vector<ChunkPlace> chunks;  ///< in the order of the file; none is empty
  bool indexed = true;
  std::uint64_t lost_bytes = 0;
};

/// The first record of a bag; error when the file is no bag of version 2.0 or is encrypted.
Result<FileRecord> read_file_header(const BagFile& file);

/// Reads the index that the file header points to.
Result<BagIndex> read_index(const BagFile& file);

/// Reads all chunks to know which are whole: those that the index tells of or, where that is gone,
/// those met when walking from the start. Chunks beyond `memory_limit` count as not whole.
Result<BagIndex> recover_index(const BagFile& file, std::size_t memory_limit);

}  // namespace aims
