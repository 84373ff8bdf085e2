// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "core/error.hpp"
#include "recordings/bag/bag_file.hpp"
#include "recordings/bag/chunk.hpp"
#include "recordings/bag/message_source.hpp"

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
