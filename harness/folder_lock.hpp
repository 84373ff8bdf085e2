// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

namespace aims {

/// Keeps other processes out of a folder as long as it lives; the system lets go when the process
/// ends, however it ends. Leaves a file `.lock` in the folder.
class FolderLock {
 public:
  /// The lock, or nothing when another process holds it or the folder cannot be written.
  static std::optional<FolderLock> take(const std::filesystem::path& folder);
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;
  ~FolderLock();

 private:
  explicit FolderLock(int descriptor) : descriptor_(descriptor) {}

  int descriptor_;
};

}  // namespace aims
