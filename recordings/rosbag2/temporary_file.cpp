// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/rosbag2/temporary_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <utility>

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "aims-unpacked-";
/// A folder is locked at most so long after it was made.
constexpr std::chrono::minutes kUnlocked{1};

std::string reason(int code) { return std::generic_category().message(code); }

/// The opened folder, locked; -1 while another process holds it.
int locked(const fs::path& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (fd < 0 || ::flock(fd, LOCK_EX | LOCK_NB) == 0) return fd;
  ::close(fd);
  return -1;
}

bool is_own(int folder) {
  struct stat status {};
  return ::fstat(folder, &status) == 0 && status.st_uid == ::geteuid();
}

/// Removes the folders whose process has ended without removing them.
void remove_left(const fs::path& temporary) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(temporary, ignored)) {
    if (!entry.path().filename().string().starts_with(kPrefix)) continue;
    const auto age = fs::file_time_type::clock::now() - entry.last_write_time(ignored);
    if (ignored || age < kUnlocked) continue;
    const int lock = locked(entry.path());
    if (lock < 0) continue;
    if (is_own(lock)) fs::remove_all(entry.path(), ignored);
    ::close(lock);
  }
}

}  // namespace

Result<TemporaryFile> TemporaryFile::create(const std::string& name, std::uint64_t size) {
  std::error_code code;
  const fs::path temporary = fs::temp_directory_path(code);
  if (code) return failure("no folder for temporary files: set TMPDIR");
  remove_left(temporary);
  const fs::space_info space = fs::space(temporary, code);
  if (!code && space.available < size) {
    return failure(fmt::format("unpacked it needs {} bytes in {}, where {} are free", size,
                               temporary.string(), space.available));
  }
  TemporaryFile file;
  file.name_ = name;
  file.file_ = ::open(temporary.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file.file_ >= 0) return file;
  if (auto made = file.make_folder(); !made) return tl::unexpected(made.error());
  file.file_ = ::open(file.path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (file.file_ >= 0) return file;
  return failure(fmt::format("{}: cannot be created: {}", file.path_.string(), reason(errno)));
}

Result<void> TemporaryFile::make_folder() {
  std::error_code code;
  std::string folder = (fs::temp_directory_path(code) / kPrefix).string() + "XXXXXX";
  if (code || ::mkdtemp(folder.data()) == nullptr) {
    return failure("no folder for temporary files: set TMPDIR");
  }
  folder_ = folder;
  path_ = folder_ / name_;
  lock_ = locked(folder_);
  return {};
}

Result<void> TemporaryFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(file_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      return failure("the unpacked file cannot be written: " + reason(errno));
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
  return {};
}

Result<void> TemporaryFile::publish() {
  const int file = std::exchange(file_, -1);
  Result<void> named;
  if (folder_.empty()) {
    named = make_folder();
    const std::string self = fmt::format("/proc/self/fd/{}", file);
    if (named &&
        ::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, path_.c_str(), AT_SYMLINK_FOLLOW) != 0) {
      named = failure(fmt::format("{}: cannot be created: {}", path_.string(), reason(errno)));
    }
  }
  ::close(file);
  return named;
}

TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept { *this = std::move(other); }

TemporaryFile& TemporaryFile::operator=(TemporaryFile&& other) noexcept {
  std::swap(name_, other.name_);
  std::swap(folder_, other.folder_);
  std::swap(path_, other.path_);
  std::swap(lock_, other.lock_);
  std::swap(file_, other.file_);
  return *this;
}

TemporaryFile::~TemporaryFile() {
  std::error_code ignored;
  if (file_ >= 0) ::close(file_);
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
  if (lock_ >= 0) ::close(lock_);
}

}  // namespace aims
