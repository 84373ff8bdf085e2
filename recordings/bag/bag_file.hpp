// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "recordings/bag/bag_records.hpp"

namespace aims {

/// A record in a file: its header is in memory, its data is not yet.
struct FileRecord {
  std::vector<std::byte> header_bytes;
  RecordFields header;  ///< points into `header_bytes`
  BagOp op = BagOp::kMessage;
  std::uint64_t position = 0;       ///< of the record
  std::uint64_t data_position = 0;  ///< of its data
  std::uint32_t data_size = 0;

  std::uint64_t end() const { return data_position + data_size; }
};

/// A file with random access; reading beyond its end is an error that names file and offset.
class BagFile {
 public:
  /// Error for a missing file, a folder or anything but a regular file.
  static Result<BagFile> open(const std::filesystem::path& file);
  BagFile(BagFile&& other) noexcept;
  BagFile& operator=(BagFile&& other) noexcept;
  ~BagFile();

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }

  /// Fills `out` from `position`, or fails when the file ends before.
  Result<void> read(std::uint64_t position, std::span<std::byte> out) const;
  /// The record at `position`, whose data lies within the file.
  Result<FileRecord> record(std::uint64_t position) const;
  /// The data of a record; error when it is longer than `max_size`.
  Result<std::vector<std::byte>> data(const FileRecord& record, std::size_t max_size) const;

  /// "FILE: at byte POSITION: WHAT".
  tl::unexpected<Error> refuse(std::uint64_t position, const std::string& what) const;

 private:
  BagFile(std::filesystem::path path, int fd, std::uint64_t size);
  std::filesystem::path path_;
  int fd_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace aims
