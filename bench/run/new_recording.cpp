// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/new_recording.hpp"

#include <fmt/format.h>

#include <system_error>

namespace aims {
namespace {

namespace fs = std::filesystem;

/// The recording while it is being written; what was recorded stays there when that fails.
fs::path partial_of(const fs::path& recording) {
  fs::path file = recording;
  return file += ".partial";
}

/// Whether nothing is there, or a file that may be replaced.
Result<void> check_free(const fs::path& file, bool overwrite, const char* what) {
  std::error_code code;
  const fs::file_status status = fs::symlink_status(file, code);
  if (status.type() == fs::file_type::not_found) return {};
  if (code) return failure(fmt::format("{}: {}", file.string(), code.message()));
  if (!overwrite) {
    return failure(fmt::format("{}: {}; choose another --out, or --overwrite to replace it",
                               file.string(), what));
  }
  if (!fs::is_regular_file(status)) {
    return failure(fmt::format("{}: expected a file to overwrite", file.string()));
  }
  return {};
}

}  // namespace

Result<RecordingFormat> format_of_new(const fs::path& file) {
  const auto format = format_by_name(file);
  if (format) return *format;
  return failure(fmt::format("{}: expected a name that ends in .bag or .mcap", file.string()));
}

Result<fs::path> begin_recording(const fs::path& file, bool overwrite) {
  std::error_code ignored;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), ignored);
  const fs::path partial = partial_of(file);
  auto free = check_free(file, overwrite, "exists already");
  if (free) free = check_free(partial, overwrite, "holds what a stopped recording left");
  if (!free) return tl::unexpected(free.error());
  fs::remove(partial, ignored);
  return partial;
}

Result<void> publish_recording(const fs::path& partial, const fs::path& file) {
  std::error_code code;
  fs::rename(partial, file, code);
  if (code) return failure(fmt::format("{}: cannot be written: {}", file.string(), code.message()));
  return {};
}

}  // namespace aims
