// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// Whether bytes begin as a frame of zstd does, which no message of ROS 2 does.
bool is_zstd_frame(std::span<const std::byte> bytes);

/// Unpacks one frame that states its size, at most `limit` bytes.
Result<void> unpack_frame(std::span<const std::byte> frame, std::size_t limit,
                          std::vector<std::byte>& out);

/// An unpacked copy of a compressed file, in the folder for temporary files. It is removed with
/// this object; who has opened it can read on.
class UnpackedFile {
 public:
  /// Error for a file that does not hold one frame that states its size, and where the space for it
  /// is missing.
  static Result<UnpackedFile> create(const std::filesystem::path& packed);
  UnpackedFile(UnpackedFile&& other) noexcept;
  UnpackedFile& operator=(UnpackedFile&& other) noexcept;
  ~UnpackedFile();

  /// Named as the packed file, without the extension of zstd.
  const std::filesystem::path& path() const { return path_; }

 private:
  explicit UnpackedFile(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

}  // namespace aims
