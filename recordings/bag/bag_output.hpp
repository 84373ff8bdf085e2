// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "core/error.hpp"

namespace aims {

/// The three operations that writing a bag needs. The file is a valid bag between and during them.
class BagOutput {
 public:
  virtual ~BagOutput() = default;
  virtual Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes) = 0;
  virtual Result<void> truncate(std::uint64_t size) = 0;
  virtual Result<void> close() = 0;
};

/// A new file that begins with `first`, which it contains from the moment it is visible. Error when
/// it exists or cannot be created.
Result<std::unique_ptr<BagOutput>> create_bag_output(const std::filesystem::path& file,
                                                     std::span<const std::byte> first);

}  // namespace aims
