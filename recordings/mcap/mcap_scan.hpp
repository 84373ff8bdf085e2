// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/error.hpp"
#include "recordings/bag/chunk.hpp"
#include "recordings/mcap/mcap_records.hpp"

namespace aims {

/// A record in a file, of which only opcode and length were read.
struct McapPlace {
  McapOp op = McapOp::kHeader;
  std::uint64_t position = 0;
  std::uint64_t size = 0;  ///< of its content [bytes]

  std::uint64_t body() const { return position + kMcapPrefix; }
  std::uint64_t end() const { return body() + size; }
};

/// The record at `position`, which lies within the file.
Result<McapPlace> mcap_place(const BagFile& file, std::uint64_t position);

/// The chunk of a record, from its first fields: with times, without counts.
/// Times that cannot be represented are an error, or with `recover` the latest possible.
Result<ChunkPlace> mcap_chunk_place(const BagFile& file, const McapPlace& record,
                                    bool recover = false);

/// What lies between two positions.
struct McapScan {
  std::vector<ChunkPlace> chunks;  ///< and runs of records outside chunks: those are of compression
                                   ///< none, without times
  std::uint64_t end = 0;           ///< behind the last complete record
  std::optional<Error> broken;     ///< why the scan ended before its end
  std::uint64_t lost_bytes = 0;    ///< of chunks that were passed over
};

/// Lists chunks and runs of schemas, channels and messages from `position` to `end`, or to the end
/// of the data section. `recover` passes over chunks that state what cannot be.
McapScan scan_mcap(const BagFile& file, std::uint64_t position, std::uint64_t end,
                   bool recover = false);

}  // namespace aims
