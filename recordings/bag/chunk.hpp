// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "core/error.hpp"
#include "core/time.hpp"
#include "recordings/bag/bag_file.hpp"
#include "recordings/bag/compression.hpp"

namespace aims {

/// Position and content of a chunk, without its messages.
struct ChunkPlace {
  std::uint64_t position = 0;       ///< of its record in the file
  std::uint64_t data_position = 0;  ///< of its packed content
  std::uint64_t packed_size = 0;    ///< [bytes]
  std::uint64_t size = 0;           ///< unpacked [bytes]
  BagCompression compression = BagCompression::kNone;
  std::uint32_t crc = 0;                          ///< of the unpacked content; 0: not stated
  Time start = 0;                                 ///< earliest record time
  Time end = 0;                                   ///< latest
  std::map<std::uint32_t, std::uint32_t> counts;  ///< messages by connection id
  std::uint32_t index_records = 0;                ///< behind the chunk

  std::uint64_t end_position() const { return data_position + packed_size; }
  /// Bytes needed to hold it in memory.
  std::uint64_t memory() const;
};

/// A message inside an unpacked chunk.
struct ChunkMessage {
  Time time = 0;
  std::uint32_t connection = 0;   ///< id
  std::uint32_t offset = 0;       ///< of its record in the chunk
  std::uint32_t data_offset = 0;  ///< of its bytes
  std::uint32_t data_size = 0;
};

/// An unpacked chunk.
struct ChunkContent {
  std::vector<std::byte> bytes;
  std::vector<std::byte> packed;       ///< buffer of the packed bytes, reused for the next chunk
  std::vector<ChunkMessage> messages;  ///< in the order of the file
};

/// Reads a chunk and unpacks it; its messages are still to be found.
Result<void> unpack_chunk(const BagFile& file, const ChunkPlace& place, ChunkContent& content);

/// "FILE: at byte N: in this chunk, at byte M of its content: WHAT".
tl::unexpected<Error> refuse_in_chunk(const BagFile& file, const ChunkPlace& place,
                                      std::size_t offset, const std::string& what);

/// Sets times and message counts of a chunk from its content.
void count_messages(const ChunkContent& content, ChunkPlace& place);

}  // namespace aims
