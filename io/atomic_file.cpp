// SPDX-License-Identifier: BSD-3-Clause
#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

namespace aims {
namespace {

namespace fs = std::filesystem;

std::string reason(int code) { return std::generic_category().message(code); }

/// An open file descriptor, closed at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }

  /// Closes now; 0, or the error number (a full network disk may speak up only here).
  int close_now() {
    const int outcome = ::close(fd_);
    fd_ = -1;
    return outcome == 0 ? 0 : errno;
  }

 private:
  int fd_;
};

/// Writes everything and flushes it to the disk; 0, or the error number.
int write_all(Descriptor& file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(file.get(), text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  // Some file systems cannot flush and say EINVAL; that is no failure to write.
  if (::fsync(file.get()) != 0 && errno != EINVAL && errno != ENOTSUP) return errno;
  return file.close_now();
}

}  // namespace

Result<void> write_file_atomically(const fs::path& file, std::string_view text) {
  const auto refuse = [&file](const std::string& why) {
    return failure(fmt::format("{}: cannot be written: {}", file.string(), why));
  };
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) return refuse("it is a directory");
  const fs::path directory = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(directory, ignored)) {
    return refuse(fmt::format("no directory '{}'", directory.string()));
  }
  const std::string temporary = fmt::format("{}.{}.tmp", file.string(), ::getpid());
  const int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd < 0) return refuse(reason(errno));
  Descriptor descriptor(fd);
  int error = write_all(descriptor, text);
  if (error == 0 && ::rename(temporary.c_str(), file.c_str()) != 0) error = errno;
  if (error == 0) return {};
  ::unlink(temporary.c_str());
  return refuse(reason(error));
}

Result<void> write_file_atomically(const fs::path& file, std::span<const std::byte> bytes) {
  return write_file_atomically(
      file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

Result<std::string> read_file(const fs::path& file) {
  const auto refuse = [&file](int code) {
    return failure(fmt::format("{}: cannot be read: {}", file.string(), reason(code)));
  };
  Descriptor descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (descriptor.get() < 0) return refuse(errno);
  std::string text;
  char buffer[1 << 16];
  while (true) {
    const ssize_t got = ::read(descriptor.get(), buffer, sizeof(buffer));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return refuse(errno);
    if (got == 0) return text;
    text.append(buffer, static_cast<std::size_t>(got));
  }
}

}  // namespace aims
