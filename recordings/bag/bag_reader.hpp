// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "recordings/bag/chunk_reader.hpp"

namespace aims {

/// Reads a ROS 1 bag (format 2.0). Each length in the file is checked before it is used.
class BagReader final : public ChunkReader {
 public:
  static Result<BagReader> open(const std::filesystem::path& file, BagOpenOptions options = {});

 private:
  using ChunkReader::ChunkReader;
};

}  // namespace aims
