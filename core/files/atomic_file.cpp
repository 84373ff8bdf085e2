// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

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

 private:
  int fd_;
};

tl::unexpected<Error> unwritable(const fs::path& file, const std::string& why) {
  return failure(fmt::format("{}: cannot be written: {}", file.string(), why));
}

/// A name that no other process uses, on this machine or another that shares the disk.
std::string temporary_name(const fs::path& file) {
  char host[256] = {};
  if (::gethostname(host, sizeof(host) - 1) != 0) host[0] = '\0';
  return fmt::format("{}.{}.{}.tmp", file.string(), host, ::getpid());
}

}  // namespace

AtomicFile::AtomicFile(fs::path file, std::string temporary, int descriptor)
    : file_(std::move(file)), temporary_(std::move(temporary)), descriptor_(descriptor) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : file_(std::move(other.file_)),
      temporary_(std::exchange(other.temporary_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

tl::unexpected<Error> AtomicFile::refuse(int code) const { return unwritable(file_, reason(code)); }

Result<AtomicFile> AtomicFile::create(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) return unwritable(file, "it is a directory");
  const fs::path directory = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(directory, ignored)) {
    return unwritable(file, fmt::format("no directory '{}'", directory.string()));
  }
  std::string temporary = temporary_name(file);
  const int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd < 0) return unwritable(file, reason(errno));
  return AtomicFile(file, std::move(temporary), fd);
}

Result<void> AtomicFile::write(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor_, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return refuse(errno);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

Result<void> AtomicFile::write(std::span<const std::byte> bytes) {
  return write(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

Result<void> AtomicFile::commit(bool flush) {
  // Some file systems cannot flush and return EINVAL; that is no write error.
  if (flush && ::fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOTSUP)
    return refuse(errno);
  // A full network disk may report the error only here.
  if (::close(std::exchange(descriptor_, -1)) != 0) return refuse(errno);
  if (::rename(temporary_.c_str(), file_.c_str()) != 0) return refuse(errno);
  temporary_.clear();
  return {};
}

Result<void> write_file_atomically(const fs::path& file, std::string_view text) {
  auto atomic = AtomicFile::create(file);
  if (!atomic) return tl::unexpected(atomic.error());
  if (auto written = atomic->write(text); !written) return written;
  return atomic->commit();
}

Result<void> write_file_atomically(const fs::path& file, std::span<const std::byte> bytes) {
  return write_file_atomically(
      file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

Result<std::string> read_file(const fs::path& file, std::size_t most) {
  const auto refuse = [&file](int code) {
    return failure(fmt::format("{}: cannot be read: {}", file.string(), reason(code)));
  };
  // Without O_NONBLOCK a pipe without a writer would hang here; a device may never end.
  Descriptor descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (descriptor.get() < 0) return refuse(errno);
  struct stat status {};
  if (::fstat(descriptor.get(), &status) != 0) return refuse(errno);
  if (S_ISDIR(status.st_mode)) return refuse(EISDIR);
  if (!S_ISREG(status.st_mode)) {
    return failure(fmt::format("{}: cannot be read: expected a regular file", file.string()));
  }
  std::string text;
  char buffer[1 << 16];
  while (true) {
    const ssize_t got = ::read(descriptor.get(), buffer, sizeof(buffer));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return refuse(errno);
    if (got == 0) return text;
    text.append(buffer, static_cast<std::size_t>(got));
    if (text.size() > most) {
      return failure(fmt::format("{}: expected at most {} bytes", file.string(), most));
    }
  }
}

}  // namespace aims
