// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/error.hpp"
#include "core/files/folder_lock.hpp"

namespace aims {

/// A folder of results that appears whole or not at all: files are written into a sibling
/// `NAME.partial`, which takes the final name on commit().
class OutputFolder {
 public:
  /// Claims the folder before any work starts. Error when `final_path` exists and `overwrite` is
  /// false, when another run is writing it, or when it cannot be written. What a killed run left
  /// behind is cleared away.
  static Result<OutputFolder> create(const std::filesystem::path& final_path, bool overwrite);
  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder& operator=(OutputFolder&&) = delete;
  /// Removes what was written when it was never committed.
  ~OutputFolder();

  /// Where to write files until commit().
  const std::filesystem::path& path() const { return partial_; }
  const std::filesystem::path& final_path() const { return final_; }

  /// Puts the folder in its place; an overwritten one leaves only then.
  Result<void> commit();

 private:
  OutputFolder() = default;

  std::filesystem::path final_;
  std::filesystem::path partial_;                   ///< empty once committed or moved from
  std::optional<FolderLock> lock_;                  ///< keeps other runs out
  std::vector<std::filesystem::path> new_parents_;  ///< made on the way, innermost first
};

}  // namespace aims
