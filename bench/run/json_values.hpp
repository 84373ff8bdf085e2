// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <type_traits>

#include "bench/run/json_text.hpp"

namespace aims {

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

}  // namespace aims
