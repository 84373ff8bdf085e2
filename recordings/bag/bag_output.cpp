// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/bag/bag_output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

namespace aims {
namespace {

class FileOutput final : public BagOutput {
 public:
  FileOutput(std::filesystem::path file, int fd) : file_(std::move(file)), fd_(fd) {}
  FileOutput(const FileOutput&) = delete;
  FileOutput& operator=(const FileOutput&) = delete;
  ~FileOutput() override {
    if (fd_ >= 0) ::close(fd_);
  }

  Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes) override {
    while (!bytes.empty()) {
      const ssize_t written = ::pwrite(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return refuse(errno);
      bytes = bytes.subspan(static_cast<std::size_t>(written));
      offset += static_cast<std::uint64_t>(written);
    }
    return {};
  }

  Result<void> truncate(std::uint64_t size) override {
    int outcome = 0;
    do {
      outcome = ::ftruncate(fd_, static_cast<off_t>(size));
    } while (outcome != 0 && errno == EINTR);
    if (outcome != 0) return refuse(errno);
    return {};
  }

  Result<void> close() override {
    // A full network disk may report the error only here.
    const int outcome = ::close(std::exchange(fd_, -1));
    if (outcome != 0) return refuse(errno);
    return {};
  }

 private:
  tl::unexpected<Error> refuse(int code) const {
    return failure(fmt::format("{}: cannot be written: {}", file_.string(),
                               std::generic_category().message(code)));
  }

  std::filesystem::path file_;
  int fd_;
};

tl::unexpected<Error> cannot_create(const std::filesystem::path& file, int code) {
  return failure(fmt::format("{}: cannot be created: {}", file.string(),
                             std::generic_category().message(code)));
}

/// A file without a name in the folder of `file`, or -1 where the file system does not support
/// this.
int open_unnamed(const std::filesystem::path& file) {
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  return ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0644);
}

/// Gives the unnamed file its name; false, with errno, when that fails or the name is taken.
bool give_name(int fd, const std::filesystem::path& file) {
  const std::string self = fmt::format("/proc/self/fd/{}", fd);
  return ::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, file.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

}  // namespace

Result<std::unique_ptr<BagOutput>> create_bag_output(const std::filesystem::path& file,
                                                     std::span<const std::byte> first) {
  if (const int fd = open_unnamed(file); fd >= 0) {
    auto output = std::make_unique<FileOutput>(file, fd);
    if (const auto written = output->write_at(0, first); !written) {
      return tl::unexpected(written.error());
    }
    if (give_name(fd, file)) return output;
    if (errno == EEXIST) return cannot_create(file, EEXIST);
  }
  const int fd = ::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (fd < 0) return cannot_create(file, errno);
  auto output = std::make_unique<FileOutput>(file, fd);
  if (const auto written = output->write_at(0, first); !written) {
    return tl::unexpected(written.error());
  }
  return output;
}

}  // namespace aims
