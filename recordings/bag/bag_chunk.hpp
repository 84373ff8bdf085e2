// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "core/error.hpp"
#include "core/time.hpp"
#include "recordings/bag/bag_file.hpp"
#include "recordings/bag/bag_reader.hpp"
#include "recordings/bag/compression.hpp"

namespace aims {

/// Connections of a bag by their ids.
class BagConnections {
 public:
  /// Adds a connection record. A repetition is accepted; a different record of the same id is an
  /// error.
  Result<void> add(const RecordFields& header, std::span<const std::byte> data);
  const BagConnection* find(std::uint32_t id) const;
  BagConnection* find(std::uint32_t id);
  const std::map<std::uint32_t, BagConnection>& all() const { return by_id_; }
  /// Sets the message counts of all connections to zero.
  void reset_counts();

 private:
  std::map<std::uint32_t, BagConnection> by_id_;
};

/// Position and content of a chunk, without its messages.
struct ChunkPlace {
  std::uint64_t position = 0;       ///< of its record in the file
  std::uint64_t data_position = 0;  ///< of its packed content
  std::uint32_t packed_size = 0;    ///< [bytes]
  std::uint32_t size = 0;           ///< unpacked [bytes]
  BagCompression compression = BagCompression::kNone;
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

/// The chunk of a record, from its header alone: without times and counts.
Result<ChunkPlace> chunk_place(const BagFile& file, const FileRecord& record);

/// Reads and unpacks a chunk, and finds its messages. Connection records inside are added to
/// `connections`; a message of another connection or an incomplete record is an error.
Result<void> load_chunk(const BagFile& file, const ChunkPlace& place, BagConnections& connections,
                        ChunkContent& content);

/// Error unless the index records behind a chunk, and its chunk info, agree with its content.
Result<void> check_chunk_index(const BagFile& file, const ChunkPlace& place,
                               const ChunkContent& content);

}  // namespace aims
