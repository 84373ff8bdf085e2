// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace aims {

/// Writes `text` to `file` so that a reader sees the old content or the new, never a part:
/// to a temporary sibling, flushed to the disk, then renamed. The directory must exist.
Result<void> write_file_atomically(const std::filesystem::path& file, std::string_view text);

/// As above for raw bytes.
Result<void> write_file_atomically(const std::filesystem::path& file,
                                   std::span<const std::byte> bytes);

/// The whole content of a file.
Result<std::string> read_file(const std::filesystem::path& file);

}  // namespace aims
