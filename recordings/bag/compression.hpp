// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// Compression of a recording's chunks: bz2 in ROS 1 bags alone, zstd in MCAP and rosbag2 alone.
enum class BagCompression { kNone, kLz4, kBz2, kZstd };

/// Its name: "none", "lz4", "bz2", "zstd".
std::string_view name_of(BagCompression compression);
std::optional<BagCompression> compression_named(std::string_view name);

/// The packed form of `bytes`: an lz4 frame, a bz2 stream, a zstd frame, or the same bytes.
Result<std::vector<std::byte>> compress(BagCompression compression,
                                        std::span<const std::byte> bytes);

/// Unpacks exactly `size` bytes into `out`. Error when the packed bytes are damaged or hold fewer
/// or more; memory grows with the bytes unpacked, up to `size`.
Result<void> decompress(BagCompression compression, std::span<const std::byte> packed,
                        std::size_t size, std::vector<std::byte>& out);

}  // namespace aims
