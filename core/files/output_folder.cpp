// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/output_folder.hpp"

#include <fmt/format.h>

#include <string>
#include <system_error>
#include <utility>

#include "core/files/manifest.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

fs::path sibling(const fs::path& path, const char* suffix) {
  fs::path result = path;
  result += suffix;
  return result;
}

tl::unexpected<Error> file_failure(const fs::path& path, const char* what,
                                   const std::error_code& code) {
  return failure(fmt::format("{}: {}: {}", path.string(), what, code.message()));
}

/// "a, b, c and 4 more"
std::string first_of(const FileList& files) {
  constexpr std::size_t kMostNamed = 5;
  std::vector<std::string> named;
  for (const std::string& file : files) {
    if (named.size() < kMostNamed) named.push_back(file);
  }
  const std::size_t more = files.size() - named.size();
  return fmt::format("{}{}", fmt::join(named, ", "),
                     more > 0 ? fmt::format(" and {} more", more) : "");
}

/// Error unless the folder is new or empty, or may be overwritten: then aims knows what it wrote.
Result<void> check_replaceable(const fs::path& path, bool overwrite) {
  std::error_code code;
  if (!fs::exists(path, code)) return {};
  const auto refusal = [&](const std::string& why) {
    return failure(fmt::format("{}: {}", path.string(), why));
  };
  if (!fs::is_directory(path, code)) return refusal("is no folder; choose another --out");
  if (fs::is_empty(path, code)) return {};
  if (!overwrite) {
    return refusal("exists already; choose another --out, or --overwrite to replace it");
  }
  if (fs::exists(path / "jobs.csv", code)) {
    return refusal("holds jobs of another aims command; choose another --out");
  }
  if (listed_files(path)) return {};
  return refusal(fmt::format(
      "has no {}, so that it is not known which of its files are results, and none is removed; "
      "choose another --out, or remove them: {}",
      kManifestFile, first_of(files_below(path))));
}

/// A path that does not exist: `path` itself, or with ".kept" at its end, as often as it takes.
fs::path free_path(fs::path path) {
  std::error_code ignored;
  while (fs::symlink_status(path, ignored).type() != fs::file_type::not_found) path += ".kept";
  return path;
}

/// Moves what aims did not write from the replaced folder into the new one.
Result<void> keep_foreign(const fs::path& replaced, const fs::path& folder) {
  const FileList written = listed_files(replaced).value_or(FileList());
  for (const std::string& file : files_below(replaced)) {
    if (written.contains(file)) continue;
    const fs::path to = free_path(folder / file);
    std::error_code code;
    fs::create_directories(to.parent_path(), code);
    if (!code) fs::rename(replaced / file, to, code);
    if (code) return file_failure(replaced / file, "is kept there, since it cannot be moved", code);
  }
  return {};
}

/// Folders above `path` that do not exist yet, innermost first.
std::vector<fs::path> missing_parents(const fs::path& path) {
  std::vector<fs::path> missing;
  for (fs::path parent = path.parent_path(); !parent.empty() && !fs::exists(parent);
       parent = parent.parent_path()) {
    missing.push_back(parent);
  }
  return missing;
}

/// Removes a partial folder unless a running process holds it; false if one does.
bool clear_stale(const fs::path& partial) {
  const auto lock = FolderLock::take(partial);
  if (!lock) return false;
  std::error_code code;
  fs::remove_all(partial, code);
  return !code;
}

}  // namespace

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : final_(std::move(other.final_)),
      partial_(std::exchange(other.partial_, {})),
      lock_(std::move(other.lock_)),
      new_parents_(std::exchange(other.new_parents_, {})) {}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!partial_.empty()) {
    fs::remove_all(partial_, ignored);
    for (const fs::path& parent : new_parents_) fs::remove(parent, ignored);
  }
}

Result<OutputFolder> OutputFolder::create(const fs::path& given, bool overwrite) {
  const fs::path final_path = given.has_filename() ? given : given.parent_path();
  if (auto allowed = check_replaceable(final_path, overwrite); !allowed) {
    return tl::unexpected(allowed.error());
  }
  const fs::path partial = sibling(final_path, ".partial");
  if (fs::exists(partial) && !clear_stale(partial)) {
    return failure(fmt::format("{}: another run is writing there", partial.string()));
  }
  OutputFolder folder;
  folder.final_ = final_path;
  folder.partial_ = partial;
  folder.new_parents_ = missing_parents(partial);
  std::error_code code;
  fs::create_directories(partial, code);
  if (code) return file_failure(partial, "cannot create the folder", code);
  if (auto lock = FolderLock::take(partial)) folder.lock_.emplace(std::move(*lock));
  if (!folder.lock_) return failure(fmt::format("{}: cannot write there", partial.string()));
  return folder;
}

Result<void> OutputFolder::commit() {
  const fs::path replaced = sibling(final_, ".replaced");
  if (auto listed = write_manifest(partial_, files_below(partial_)); !listed) return listed;
  std::error_code code;
  const bool replaces = fs::exists(final_) && !fs::is_empty(final_);
  if (replaces) fs::rename(final_, replaced, code);
  if (code) return file_failure(final_, "cannot be replaced", code);
  fs::remove(partial_ / ".lock", code);
  fs::rename(partial_, final_, code);
  if (code) return file_failure(final_, "cannot be written", code);
  partial_.clear();
  if (!replaces) return {};
  auto kept = keep_foreign(replaced, final_);
  if (kept) fs::remove_all(replaced, code);
  return kept;
}

}  // namespace aims
