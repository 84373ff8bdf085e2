// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace aims {

/// A file that is written in pieces and appears whole or not at all: the pieces go to a temporary
/// sibling, which takes the file's name on commit(). Errors name the file and the reason, e.g. that
/// no space is left.
class AtomicFile {
 public:
  /// The directory must exist; nothing of the file changes yet.
  static Result<AtomicFile> create(const std::filesystem::path& file);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  /// Removes what was written when it was never committed.
  ~AtomicFile();

  Result<void> write(std::string_view text);
  Result<void> write(std::span<const std::byte> bytes);
  /// Puts the file in its place; before that flushes it to the disk, unless `flush` is false: then
  /// a power failure soon after may leave it short or with zeros.
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

/// The whole content of a file.
Result<std::string> read_file(const std::filesystem::path& file);

}  // namespace aims
