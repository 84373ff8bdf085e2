// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace aims {
namespace {

constexpr int kCreate = O_RDWR | O_CREAT;  ///< a separate lock file

}  // namespace

std::optional<FolderLock> FolderLock::take(const std::filesystem::path& folder) {
  return lock(folder / ".lock", LOCK_EX | LOCK_NB, kCreate);
}

std::optional<FolderLock> FolderLock::share(const std::filesystem::path& folder) {
  return lock(folder / ".lock", LOCK_SH | LOCK_NB, kCreate);
}

std::optional<FolderLock> FolderLock::wait(const std::filesystem::path& folder,
                                           const std::string& name) {
  return lock(folder / name, LOCK_EX, kCreate);
}

std::optional<FolderLock> FolderLock::take_file(const std::filesystem::path& file) {
  return lock(file, LOCK_EX | LOCK_NB,
              O_RDWR);  // some network disks require a file open for writing
}

std::optional<FolderLock> FolderLock::share_file(const std::filesystem::path& file) {
  return lock(file, LOCK_SH | LOCK_NB, O_RDONLY);
}

std::optional<FolderLock> FolderLock::lock(const std::filesystem::path& file, int operation,
                                           int flags) {
  const int descriptor = open(file.c_str(), flags | O_CLOEXEC, 0644);
  if (descriptor < 0) return std::nullopt;
  int outcome = flock(descriptor, operation);
  while (outcome != 0 && errno == EINTR) outcome = flock(descriptor, operation);
  if (outcome == 0) return FolderLock(descriptor);
  close(descriptor);
  return std::nullopt;
}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

}  // namespace aims
