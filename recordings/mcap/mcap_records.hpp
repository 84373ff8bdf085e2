// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/files/byte_cursor.hpp"
#include "core/time.hpp"

namespace aims {

/// The first and the last bytes of an MCAP file. Format: https://mcap.dev/spec
inline constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);
/// Bytes of a record's opcode and length.
inline constexpr std::uint64_t kMcapPrefix = 9;
/// Content of the footer [bytes].
inline constexpr std::uint64_t kMcapFooterSize = 20;

enum class McapOp : std::uint8_t {
  kHeader = 1,
  kFooter = 2,
  kSchema = 3,
  kChannel = 4,
  kMessage = 5,
  kChunk = 6,
  kMessageIndex = 7,
  kChunkIndex = 8,
  kAttachment = 9,
  kAttachmentIndex = 10,
  kStatistics = 11,
  kMetadata = 12,
  kMetadataIndex = 13,
  kSummaryOffset = 14,
  kDataEnd = 15,
};

/// Name of the record type in errors.
std::string_view name_of(McapOp op);

/// A record inside bytes already in memory.
struct McapRecord {
  McapOp op = McapOp::kMessage;
  std::span<const std::byte> body;
};

/// The record at the cursor; the error states what was expected, not where.
Result<McapRecord> read_mcap_record(ByteCursor& cursor);

// The records that are read. Each parser returns nothing when the body is too short; bytes behind
// the known fields are left unread, as the format demands.

struct McapSchema {
  std::uint16_t id = 0;
  std::string_view name;
  std::string_view encoding;
  std::string_view text;
};
std::optional<McapSchema> parse_schema(std::span<const std::byte> body);

struct McapChannel {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;  ///< 0: none
  std::string_view topic;
  std::string_view encoding;
  std::vector<std::pair<std::string_view, std::string_view>> metadata;

  /// The value of that key, or empty.
  std::string_view find(std::string_view key) const;
};
std::optional<McapChannel> parse_channel(std::span<const std::byte> body);

struct McapMessage {
  std::uint16_t channel = 0;
  std::uint64_t log_time = 0;  ///< [ns]
  std::span<const std::byte> data;
};
std::optional<McapMessage> parse_message(std::span<const std::byte> body);

/// The fields of a chunk in front of its records.
struct McapChunk {
  std::uint64_t start = 0;  ///< [ns]
  std::uint64_t end = 0;    ///< [ns]
  std::uint64_t size = 0;   ///< unpacked [bytes]
  std::uint32_t crc = 0;    ///< of the unpacked records; 0: not stated
  std::string_view compression;
  std::uint64_t packed_size = 0;  ///< [bytes]
  std::uint64_t header_size = 0;  ///< of these fields [bytes]
};
std::optional<McapChunk> parse_chunk(std::span<const std::byte> body);

struct McapChunkIndex {
  std::uint64_t position = 0;  ///< of the chunk's record
  std::uint64_t length = 0;    ///< of the chunk's record [bytes]
  std::vector<std::uint16_t> channels;
  std::uint64_t index_length = 0;  ///< of the message indexes behind the chunk [bytes]
};
std::optional<McapChunkIndex> parse_chunk_index(std::span<const std::byte> body);

struct McapStatistics {
  std::uint64_t messages = 0;
  std::uint32_t chunks = 0;
  std::vector<std::pair<std::uint16_t, std::uint64_t>> counts;  ///< messages by channel
};
std::optional<McapStatistics> parse_statistics(std::span<const std::byte> body);

struct McapFooter {
  std::uint64_t summary = 0;  ///< position; 0: none
  std::uint32_t crc = 0;      ///< of the summary up to this field; 0: not stated
};
std::optional<McapFooter> parse_footer(std::span<const std::byte> body);

}  // namespace aims
