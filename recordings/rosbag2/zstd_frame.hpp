// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "recordings/rosbag2/temporary_file.hpp"

namespace aims {

/// Whether bytes begin as a frame of zstd does, which no message of ROS 2 does.
bool is_zstd_frame(std::span<const std::byte> bytes);

/// Unpacks one frame that states its size, at most `limit` bytes.
Result<void> unpack_frame(std::span<const std::byte> frame, std::size_t limit,
                          std::vector<std::byte>& out);

/// An unpacked copy of a compressed file, named as that without the extension of zstd. Error for a
/// file that does not hold one frame that states its size, and where the space for it is missing.
Result<TemporaryFile> unpack_file(const std::filesystem::path& packed);

}  // namespace aims
