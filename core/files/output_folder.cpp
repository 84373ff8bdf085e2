// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/output_folder.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

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

/// A folder without results is never replaced, even with --overwrite.
Result<void> check_replaceable(const fs::path& path, bool overwrite) {
  if (!fs::exists(path)) return {};
  if (!overwrite) {
    return failure(fmt::format(
        "{}: exists already; choose another --out, or --overwrite to replace it", path.string()));
  }
  const bool holds_results =
      fs::exists(path / "scores.json") || fs::exists(path / "summary.json") ||
      fs::exists(path / "detectors.json") || fs::exists(path / "render.json");
  if (holds_results || (fs::is_directory(path) && fs::is_empty(path))) return {};
  return failure(fmt::format("{}: holds no results (no scores.json), so it is not overwritten",
                             path.string()));
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
  std::error_code code;
  const bool replaces = fs::exists(final_);
  if (replaces) fs::rename(final_, replaced, code);
  if (code) return file_failure(final_, "cannot be replaced", code);
  fs::remove(partial_ / ".lock", code);
  fs::rename(partial_, final_, code);
  if (code) return file_failure(final_, "cannot be written", code);
  partial_.clear();
  if (replaces) fs::remove_all(replaced, code);
  return {};
}

}  // namespace aims
