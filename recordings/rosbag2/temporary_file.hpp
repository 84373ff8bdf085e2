// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "core/error.hpp"

namespace aims {

/// A file for as long as this object lives, in a new folder of that for temporary files (TMPDIR).
/// Until `publish` it has no name where the file system supports this, so that a process that is
/// killed while it writes leaves nothing. Who has opened the file can read on when it is removed.
class TemporaryFile {
 public:
  /// Removes first what processes that were killed after `publish` have left. Error when there is
  /// no folder for temporary files, or fewer than `size` bytes are free in it.
  static Result<TemporaryFile> create(const std::string& name, std::uint64_t size);
  TemporaryFile(TemporaryFile&& other) noexcept;
  TemporaryFile& operator=(TemporaryFile&& other) noexcept;
  ~TemporaryFile();

  Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes);

  /// Gives the file its name; nothing can be written after.
  Result<void> publish();

  /// Its last part is the name given to `create`; a file is there after `publish`.
  const std::filesystem::path& path() const { return path_; }

 private:
  TemporaryFile() = default;
  Result<void> make_folder();

  std::string name_;
  std::filesystem::path folder_;  ///< empty until it is made
  std::filesystem::path path_;
  int lock_ = -1;  ///< the folder, locked while this process lives
  int file_ = -1;
};

}  // namespace aims
