// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/json_text.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <system_error>

#include "core/files/atomic_file.hpp"
#include "core/text.hpp"

namespace aims {

namespace {

constexpr int kDeepest = 64;

Json with_utf8(const Json& json) {
  if (json.is_string()) return utf8_text(json.get_ref<const std::string&>());
  if (json.is_array()) {
    Json result = Json::array();
    for (const Json& each : json) result.push_back(with_utf8(each));
    return result;
  }
  if (!json.is_object()) return json;
  Json result = Json::object();
  for (const auto& [key, value] : json.items()) result[utf8_text(key)] = with_utf8(value);
  return result;
}

}  // namespace

std::string json_text(const Json& json, int indent) {
  try {
    return json.dump(indent);
  } catch (const Json::type_error&) {  // a text that is not UTF-8
    return with_utf8(json).dump(indent);
  }
}

Result<Json> parse_json(std::string_view text, const std::string& name) {
  int deepest = 0;
  const auto within = [&deepest](int depth, Json::parse_event_t /*event*/, Json& /*value*/) {
    deepest = std::max(deepest, depth);
    return depth <= kDeepest;
  };
  Json json = Json::parse(text, within, false);
  if (deepest > kDeepest) {
    return failure(fmt::format("{}: is nested more than {} deep", name, kDeepest));
  }
  if (json.is_discarded()) return failure(fmt::format("{}: is incomplete or not JSON", name));
  return json;
}

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

Result<void> write_json(const fs::path& file, const Json& json, int indent) {
  return write_file_atomically(file, json_text(json, indent) + "\n");
}

Result<Json> read_json_of(const fs::path& file, std::string_view schema) {
  const auto text = read_file(file);
  if (!text) return tl::unexpected(text.error());
  auto json = parse_json(*text, file.string());
  if (!json) return json;
  if (text_in(*json, "schema") == schema) return json;
  return failure(fmt::format("{}: expected a document of schema {}", file.string(), schema));
}

}  // namespace aims
