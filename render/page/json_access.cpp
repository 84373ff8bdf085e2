// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/json_access.hpp"

#include <fmt/format.h>

#include <cmath>
#include <system_error>

#include "bench/run/json_text.hpp"
#include "core/files/atomic_file.hpp"

namespace aims {

namespace fs = std::filesystem;

const Json& member(const Json& json, const std::string& key) {
  static const Json none;
  if (!json.is_object()) return none;
  const auto found = json.find(key);
  return found == json.end() ? none : *found;
}

std::string text_in(const Json& json, const std::string& key) {
  const Json& value = member(json, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

std::optional<double> number_in(const Json& json, const std::string& key) {
  const Json& value = member(json, key);
  if (!value.is_number()) return std::nullopt;
  const double number = value.get<double>();
  return std::isfinite(number) ? std::optional<double>(number) : std::nullopt;
}

Result<Json> read_json_of(const fs::path& file, std::string_view schema) {
  const auto text = read_file(file);
  if (!text) return tl::unexpected(text.error());
  auto json = parse_json(*text, file.string());
  if (!json) return json;
  if (text_in(*json, "schema") == schema) return json;
  return failure(fmt::format("{}: expected a document of schema {}", file.string(), schema));
}

std::string folder_name(const fs::path& folder) {
  std::error_code ignored;
  fs::path full = fs::weakly_canonical(folder, ignored);
  if (ignored) full = folder;
  if (!full.has_filename()) full = full.parent_path();
  return full.filename().string();
}

}  // namespace aims
