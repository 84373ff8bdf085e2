// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace aims {

/// A file that is written in parts and appears completely or not at all: a temporary sibling is
/// renamed on commit(). Errors name the file and the reason, e.g. that no space is left.
class AtomicFile {
 public:
  /// The directory must exist; an existing file is unchanged until commit().
  static Result<AtomicFile> create(const std::filesystem::path& file);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  /// Removes the temporary file without commit().
  ~AtomicFile();

  Result<void> write(std::string_view text);
  Result<void> write(std::span<const std::byte> bytes);
  /// Flushes and renames the file. Without `flush`, a power failure soon after may leave it
  /// truncated or with zeros.
  Result<void> commit(bool flush = true);

 private:
  AtomicFile(std::filesystem::path file, std::string temporary, int descriptor);
  tl::unexpected<Error> refuse(int code) const;

  std::filesystem::path file_;
  std::string temporary_;  ///< empty once committed or moved from
  int descriptor_ = -1;
};

/// Writes `text` to `file` so that a reader sees the old content or the new, never a part:
/// to a temporary sibling, flushed to the disk, then renamed. The directory must exist.
Result<void> write_file_atomically(const std::filesystem::path& file, std::string_view text);

/// As above for raw bytes.
Result<void> write_file_atomically(const std::filesystem::path& file,
                                   std::span<const std::byte> bytes);

/// The content of a file. Error when it has more than `most` bytes.
Result<std::string> read_file(const std::filesystem::path& file,
                              std::size_t most = std::numeric_limits<std::size_t>::max());

}  // namespace aims
