// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// File in a folder of results that lists, one a line and relative to the folder, the files that
/// aims wrote there. Only those may be removed.
inline constexpr const char* kManifestFile = ".aims-files";

/// Paths relative to a folder, with '/' between their parts.
using FileList = std::set<std::string>;

/// Every file and symbolic link in `folder` and below, without the manifest and the lock.
FileList files_below(const std::filesystem::path& folder);

/// What the manifest of the folder lists; none when it has no manifest.
std::optional<FileList> listed_files(const std::filesystem::path& folder);

/// Writes the manifest. Error when it cannot be written.
Result<void> write_manifest(const std::filesystem::path& folder, const FileList& files);

/// Adds a file to the manifest of its folder, if that has one.
void add_to_manifest(const std::filesystem::path& file);

}  // namespace aims
