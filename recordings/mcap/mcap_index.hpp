// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "core/error.hpp"
#include "recordings/bag/chunk.hpp"
#include "recordings/mcap/mcap_definitions.hpp"

namespace aims {

/// Channels and chunks of an MCAP file. Messages outside chunks form chunks of their own here, up
/// to some megabytes of adjacent records each.
struct McapIndex {
  McapDefinitions definitions;
  std::vector<ChunkPlace> chunks;                 ///< in the order of the file; none is empty
  std::map<std::uint32_t, std::uint64_t> counts;  ///< messages by channel
  std::uint64_t messages = 0;
  bool indexed = true;
  bool closed = true;  ///< it has a footer
  std::uint64_t lost_bytes = 0;
  std::uint64_t lost_messages = 0;  ///< with times that cannot be represented
};

/// Reads the summary at the end of the file or, where it has none or not all that is needed, every
/// chunk. Error when the file is no MCAP, was never closed or is damaged.
Result<McapIndex> read_mcap_index(const BagFile& file, std::size_t memory_limit);

/// Reads all chunks and keeps the intact ones: those that the summary lists or, without it, those
/// found from the start. Chunks beyond `memory_limit` count as damaged.
Result<McapIndex> recover_mcap_index(const BagFile& file, std::size_t memory_limit);

/// Reads and unpacks a chunk, and finds its messages. Schemas and channels inside are added to
/// `definitions`; a message of another channel or an incomplete record is an error.
/// A message with a time of 2^63 ns or more is one too, unless `lost_messages` counts it.
Result<void> load_mcap_chunk(const BagFile& file, const ChunkPlace& place,
                             McapDefinitions& definitions, ChunkContent& content,
                             std::uint64_t* lost_messages = nullptr);

}  // namespace aims
