// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace aims {

/// Exclusive or shared lock of a folder for the lifetime of the object; the system releases it when
/// the process ends for any reason. Leaves a file `.lock` in the folder.
class FolderLock {
 public:
  /// The lock, or nothing when another process holds it or the folder cannot be written.
  static std::optional<FolderLock> take(const std::filesystem::path& folder);
  /// A shared lock, or nothing when another process holds it exclusively.
  static std::optional<FolderLock> share(const std::filesystem::path& folder);
  /// Waits for the lock on the file `name` in the folder; nothing when it cannot be written.
  static std::optional<FolderLock> wait(const std::filesystem::path& folder,
                                        const std::string& name);
  /// An exclusive or shared lock of a file; nothing when it does not exist or is locked.
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
