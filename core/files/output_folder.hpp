// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/error.hpp"
#include "core/files/folder_lock.hpp"

namespace aims {

/// A folder of results that appears completely or not at all: files are written to a sibling
/// `NAME.partial`, which is renamed on commit(). A manifest in it (core/files/manifest.hpp) lists
/// them, so that overwriting removes them and nothing else.
class OutputFolder {
 public:
  /// Claims the folder before any work starts. Error when `final_path` exists, is not empty and
  /// `overwrite` is false or it has no manifest, when another run is writing it, or when it cannot
  /// be written. Remains of a killed run are removed.
  static Result<OutputFolder> create(const std::filesystem::path& final_path, bool overwrite);
  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder& operator=(OutputFolder&&) = delete;
  /// Removes the partial folder without commit().
  ~OutputFolder();

  /// Where to write files until commit().
  const std::filesystem::path& path() const { return partial_; }
  const std::filesystem::path& final_path() const { return final_; }

  /// Renames the folder. Only then are the files of an overwritten one removed; those that aims did
  /// not write stay, as NAME.kept where a new file has their name.
  Result<void> commit();

 private:
  OutputFolder() = default;

  std::filesystem::path final_;
  std::filesystem::path partial_;                   ///< empty once committed or moved from
  std::optional<FolderLock> lock_;                  ///< against other runs
  std::vector<std::filesystem::path> new_parents_;  ///< created for this folder, innermost first
};

}  // namespace aims
