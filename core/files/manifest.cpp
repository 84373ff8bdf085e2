// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/manifest.hpp"

#include <system_error>

#include "core/files/atomic_file.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

}  // namespace

FileList files_below(const fs::path& folder) {
  FileList files;
  std::error_code code;
  for (fs::recursive_directory_iterator at(folder, code), end; !code && at != end;
       at.increment(code)) {
    std::error_code ignored;
    if (at->is_directory(ignored) && !at->is_symlink(ignored)) continue;
    const std::string name = at->path().lexically_relative(folder).generic_string();
    if (name != kManifestFile && name != ".lock") files.insert(name);
  }
  return files;
}

std::optional<FileList> listed_files(const fs::path& folder) {
  const auto text = read_file(folder / kManifestFile);
  if (!text) return std::nullopt;
  FileList files;
  for (const std::string& line : split(*text, '\n')) {
    if (!line.empty()) files.insert(line);
  }
  return files;
}

Result<void> write_manifest(const fs::path& folder, const FileList& files) {
  std::string text;
  for (const std::string& file : files) text += file + "\n";
  return write_file_atomically(folder / kManifestFile, text);
}

void add_to_manifest(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  auto files = listed_files(folder);
  if (!files || !files->insert(file.filename().string()).second) return;
  // Without the line, the file counts as the user's and stays: no reason to fail.
  (void)write_manifest(folder, *files);
}

}  // namespace aims
