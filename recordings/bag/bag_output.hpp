// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "core/error.hpp"

namespace aims {

/// The three things that writing a bag does to a file. Between any two of them the file is a whole
/// bag, and so it is while a call is under way.
class BagOutput {
 public:
  virtual ~BagOutput() = default;
  virtual Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes) = 0;
  virtual Result<void> truncate(std::uint64_t size) = 0;
  virtual Result<void> close() = 0;
};

/// A new file that begins with `first`: under its name it is never seen without. Error when it
/// exists or cannot be made.
Result<std::unique_ptr<BagOutput>> create_bag_output(const std::filesystem::path& file,
                                                     std::span<const std::byte> first);

}  // namespace aims
