// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "core/error.hpp"

namespace aims {

using Json = nlohmann::ordered_json;

/// JSON text with `indent` blanks a level, -1 for one line. Names in it may hold any bytes: what is
/// not UTF-8 becomes \xNN (`utf8_text`).
std::string json_text(const Json& json, int indent);

/// Reads JSON text. Error, which calls it `name`, when it is incomplete, no JSON, or nested deeper
/// than any file of this program.
Result<Json> parse_json(std::string_view text, const std::string& name);

/// The value of that key; `fallback` when `json` is no object, has none, or one of another type, as
/// a file may that somebody edited.
template <class Value>
Value value_in(const Json& json, const std::string& key, Value fallback) {
  if (!json.is_object()) return fallback;
  const auto found = json.find(key);
  if (found == json.end()) return fallback;
  if constexpr (std::is_same_v<Value, Json>) {
    return *found;
  } else if constexpr (std::is_same_v<Value, std::string>) {
    return found->is_string() ? found->get<std::string>() : fallback;
  } else if constexpr (std::is_same_v<Value, bool>) {
    return found->is_boolean() ? found->get<bool>() : fallback;
  } else {
    return found->is_number() ? found->get<Value>() : fallback;
  }
}

/// As above for a text.
inline std::string value_in(const Json& json, const std::string& key, const char* fallback) {
  return value_in(json, key, std::string(fallback));
}

/// What `to_json`, a function or a member, makes of each element.
template <class Range, class ToJson>
Json json_array(const Range& range, ToJson to_json) {
  Json array = Json::array();
  for (const auto& each : range) array.push_back(Json(std::invoke(to_json, each)));
  return array;
}

/// The member of that key; null when `json` is no object or has none.
const Json& member(const Json& json, const std::string& key);

/// The text of that key; empty when it is no text.
std::string text_in(const Json& json, const std::string& key);

/// The finite number of that key; none when it is none.
std::optional<double> number_in(const Json& json, const std::string& key);

/// Writes the text atomically, with a line end.
Result<void> write_json(const std::filesystem::path& file, const Json& json, int indent = 2);

/// Reads a JSON document of that schema. Error with the file and what was expected.
Result<Json> read_json_of(const std::filesystem::path& file, std::string_view schema);

}  // namespace aims
