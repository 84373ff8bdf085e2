// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/bag/bag_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace aims {
namespace {

/// Headers hold a topic and a few numbers [bytes].
constexpr std::uint32_t kMaxHeaderBytes = 1 << 16;
/// Bytes of the first read, enough for most headers.
constexpr std::size_t kFirstReadBytes = 256;

tl::unexpected<Error> cannot_read(const std::filesystem::path& file, const std::string& why) {
  return failure(fmt::format("{}: cannot be read: {}", file.string(), why));
}

std::string reason(int code) { return std::generic_category().message(code); }

}  // namespace

Result<BagFile> BagFile::open(const std::filesystem::path& file) {
  // Without O_NONBLOCK a pipe without a writer would hang here.
  const int fd = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) return cannot_read(file, reason(errno));
  BagFile opened(file, fd, 0);
  struct stat status {};
  if (::fstat(fd, &status) != 0) return cannot_read(file, reason(errno));
  if (S_ISDIR(status.st_mode)) return cannot_read(file, "it is a directory, expected a bag");
  if (!S_ISREG(status.st_mode)) return cannot_read(file, "expected a regular file");
  opened.size_ = static_cast<std::uint64_t>(status.st_size);
  return opened;
}

BagFile::BagFile(std::filesystem::path path, int fd, std::uint64_t size)
    : path_(std::move(path)), fd_(fd), size_(size) {}

BagFile::BagFile(BagFile&& other) noexcept
    : path_(std::move(other.path_)), fd_(std::exchange(other.fd_, -1)), size_(other.size_) {}

BagFile& BagFile::operator=(BagFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(fd_, other.fd_);
  std::swap(size_, other.size_);
  return *this;
}

BagFile::~BagFile() {
  if (fd_ >= 0) ::close(fd_);
}

Result<void> BagFile::read(std::uint64_t position, std::span<std::byte> out) const {
  if (position > size_ || out.size() > size_ - position) {
    return refuse(position, fmt::format("expected {} bytes, but the file ends at byte {}",
                                        out.size(), size_));
  }
  while (!out.empty()) {
    const ssize_t got = ::pread(fd_, out.data(), out.size(), static_cast<off_t>(position));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return refuse(position, reason(errno));
    if (got == 0) return refuse(position, "the file became shorter while it was read");
    out = out.subspan(static_cast<std::size_t>(got));
    position += static_cast<std::uint64_t>(got);
  }
  return {};
}

Result<FileRecord> BagFile::record(std::uint64_t position) const {
  constexpr std::size_t kLength = sizeof(std::uint32_t);
  if (position >= size_ || size_ - position < 2 * kLength) {
    return refuse(position, fmt::format("expected a record, but the file ends at byte {}", size_));
  }
  FileRecord record;
  record.position = position;
  std::vector<std::byte>& bytes = record.header_bytes;
  bytes.resize(std::min<std::uint64_t>(kFirstReadBytes, size_ - position));
  if (const auto got = read(position, bytes); !got) return tl::unexpected(got.error());
  const auto header_size = load_number<std::uint32_t>(bytes.data());
  if (header_size > kMaxHeaderBytes) {
    return refuse(position, fmt::format("expected a record's header of at most {} bytes, found {}",
                                        kMaxHeaderBytes, header_size));
  }
  const std::size_t total = 2 * kLength + header_size;
  const std::size_t known = bytes.size();
  bytes.resize(total);
  if (total > known) {
    const auto got = read(position + known, std::span(bytes).subspan(known));
    if (!got) return tl::unexpected(got.error());
  }
  const auto fields = RecordFields::parse(std::span(bytes).subspan(kLength, header_size));
  if (!fields) return refuse(position, fields.error().message);
  const auto op = fields->op();
  if (!op) return refuse(position, "expected a record's header with 'op' from 2 to 7");
  record.header = *fields;
  record.op = *op;
  record.data_position = position + total;
  record.data_size = load_number<std::uint32_t>(bytes.data() + kLength + header_size);
  if (record.data_size > size_ - record.data_position) {
    return refuse(position, fmt::format("expected {} bytes of {}, but the file ends at byte {}",
                                        record.data_size, name_of(*op), size_));
  }
  return record;
}

Result<std::vector<std::byte>> BagFile::data(const FileRecord& record, std::size_t max_size) const {
  if (record.data_size > max_size) {
    return refuse(record.position, fmt::format("expected at most {} bytes of {}, found {}",
                                               max_size, name_of(record.op), record.data_size));
  }
  std::vector<std::byte> bytes(record.data_size);
  if (const auto got = read(record.data_position, bytes); !got) {
    return tl::unexpected(got.error());
  }
  return bytes;
}

tl::unexpected<Error> BagFile::refuse(std::uint64_t position, const std::string& what) const {
  return failure(fmt::format("{}: at byte {}: {}", path_.string(), position, what));
}

}  // namespace aims
