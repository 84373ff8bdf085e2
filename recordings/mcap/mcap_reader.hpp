// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "recordings/bag/chunk_reader.hpp"

namespace aims {

/// Reads an MCAP file, with or without index, with chunks that are compressed by lz4 or zstd, or
/// without chunks; messages of ROS 2 (cdr) or ROS 1. Each length in the file is checked before it
/// is used, and every checksum of a chunk.
class McapReader final : public ChunkReader {
 public:
  static Result<McapReader> open(const std::filesystem::path& file, BagOpenOptions options = {});

 private:
  using ChunkReader::ChunkReader;
};

}  // namespace aims
