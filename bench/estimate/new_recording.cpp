// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/new_recording.hpp"

#include <fmt/format.h>

#include <system_error>

#include "recordings/rosbag2/rosbag2_metadata.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// The recording while it is being written; what was recorded stays there when that fails.
fs::path partial_of(const fs::path& recording) {
  fs::path file = recording;
  return file += ".partial";
}

/// Whether a folder holds nothing but what a recording of rosbag2 consists of.
bool is_rosbag2_folder(const fs::path& folder) {
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(folder, code)) {
    const std::string name = entry.path().filename().string();
    const bool known = name == kRosbag2Metadata || name.find(".db3") != std::string::npos ||
                       entry.path().extension() == ".mcap";
    if (!known || !entry.is_regular_file(code)) return false;
  }
  return !code;
}

/// Whether nothing is there, or a recording that may be replaced.
Result<void> check_free(const fs::path& file, bool overwrite, const char* what) {
  std::error_code code;
  const fs::file_status status = fs::symlink_status(file, code);
  if (status.type() == fs::file_type::not_found) return {};
  if (code) return failure(fmt::format("{}: {}", file.string(), code.message()));
  if (!overwrite) {
    return failure(fmt::format("{}: {}; choose another --out, or --overwrite to replace it",
                               file.string(), what));
  }
  if (fs::is_regular_file(status)) return {};
  if (fs::is_directory(status) && is_rosbag2_folder(file)) return {};
  return failure(fmt::format("{}: expected a recording to overwrite", file.string()));
}

}  // namespace

Result<RecordingFormat> format_of_new(const fs::path& file) {
  if (!file.has_filename()) return RecordingFormat::kRosbag2;
  const auto format = format_by_name(file);
  if (format == RecordingFormat::kBag || format == RecordingFormat::kMcap) return *format;
  return failure(
      fmt::format("{}: expected a name that ends in .bag, .mcap, or / for a folder of "
                  "rosbag2",
                  file.string()));
}

fs::path path_of_new(const fs::path& file) {
  return file.has_filename() ? file : file.parent_path();
}

Result<fs::path> begin_recording(const fs::path& file, bool overwrite) {
  std::error_code ignored;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), ignored);
  const fs::path partial = partial_of(file);
  auto free = check_free(file, overwrite, "exists already");
  if (free) free = check_free(partial, overwrite, "holds what a stopped recording left");
  if (!free) return tl::unexpected(free.error());
  fs::remove_all(partial, ignored);
  return partial;
}

Result<void> publish_recording(const fs::path& partial, const fs::path& file) {
  std::error_code code;
  // A folder cannot replace another: the old one is set aside first.
  fs::path old = file;
  old += ".replaced";
  const bool folder = fs::is_directory(file, code);
  if (folder) fs::rename(file, old, code);
  if (!folder || !code) fs::rename(partial, file, code);
  if (code) return failure(fmt::format("{}: cannot be written: {}", file.string(), code.message()));
  if (folder) fs::remove_all(old, code);
  return {};
}

std::uintmax_t recording_size(const fs::path& recording) {
  std::error_code code;
  if (!fs::is_directory(recording, code)) return fs::file_size(recording, code);
  std::uintmax_t size = 0;
  for (const auto& entry : fs::directory_iterator(recording, code)) size += entry.file_size(code);
  return size;
}

}  // namespace aims
