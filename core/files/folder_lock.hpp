// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace aims {

/// Keeps other processes out of a folder as long as it lives; the system lets go when the process
/// ends, however it ends. Leaves a file `.lock` in the folder.
class FolderLock {
 public:
  /// The lock, or nothing when another process holds it or the folder cannot be written.
  static std::optional<FolderLock> take(const std::filesystem::path& folder);
  /// As `take`, together with others who share the folder; nothing when somebody has it alone.
  static std::optional<FolderLock> share(const std::filesystem::path& folder);
  /// The lock by the file `name` in the folder, once nobody else holds it; nothing when it cannot
  /// be written.
  static std::optional<FolderLock> wait(const std::filesystem::path& folder,
                                        const std::string& name);
  /// The lock of a file itself, alone or together with others who share it; nothing when it is not
  /// there or somebody has it otherwise.
  static std::optional<FolderLock> take_file(const std::filesystem::path& file);
  static std::optional<FolderLock> share_file(const std::filesystem::path& file);
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;
  ~FolderLock();

 private:
  static std::optional<FolderLock> lock(const std::filesystem::path& file, int operation,
                                        int flags);
  explicit FolderLock(int descriptor) : descriptor_(descriptor) {}

  int descriptor_;
};

}  // namespace aims
