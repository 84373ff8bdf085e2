// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/page_pictures.hpp"

#include <string_view>

#include "core/files/atomic_file.hpp"
#include "render/page/page_data.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";

}  // namespace

Result<Json> pictures_json(const fs::path& folder, const std::vector<PagePicture>& pictures,
                           std::uintmax_t largest, Json& notes) {
  Json list = Json::array();
  for (const auto& [name, title] : pictures) {
    const fs::path file = folder / (name + ".png");
    if (!fs::is_regular_file(file) || fs::file_size(file) > largest) continue;
    const auto bytes = read_file(file);
    if (!bytes) return tl::unexpected(bytes.error());
    if (!bytes->starts_with(kPngSignature)) {
      notes.push_back(file.filename().string() + " is no PNG picture and is left out.");
      continue;
    }
    list.push_back({{"name", name}, {"title", title}, {"png", base64(*bytes)}});
  }
  return list;
}

}  // namespace aims
