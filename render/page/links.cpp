// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/links.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <system_error>

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Whether `path` is below `folder`; both without links.
bool is_inside(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

}  // namespace

Result<void> check_links(const fs::path& folder) {
  std::error_code code;
  const fs::path inside = fs::canonical(folder, code);
  if (code) return failure(fmt::format("{}: {}", folder.string(), code.message()));
  for (const auto& entry : fs::directory_iterator(inside, code)) {
    std::error_code unknown;
    if (!entry.is_symlink(unknown) || entry.is_directory(unknown)) continue;
    const fs::path target = fs::weakly_canonical(entry.path(), unknown);
    if (!unknown && is_inside(target, inside)) continue;
    return failure(fmt::format("{}: is a link to a file outside the folder; expected a file in it",
                               (folder / entry.path().filename()).string()));
  }
  return {};
}

std::string link_to(const fs::path& relative) {
  std::string link;
  for (const char c : relative.generic_string()) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = byte < 128 && (std::isalnum(byte) != 0 ||
                                      std::string("-._~/").find(c) != std::string::npos);
    link += plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return link;
}

std::string folder_name(const fs::path& folder) {
  std::error_code ignored;
  fs::path full = fs::weakly_canonical(folder, ignored);
  if (ignored) full = folder;
  if (!full.has_filename()) full = full.parent_path();
  return full.filename().string();
}

}  // namespace aims
