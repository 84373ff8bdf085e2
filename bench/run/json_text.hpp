// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace aims {

using Json = nlohmann::ordered_json;

/// JSON text with `indent` blanks a level, -1 for one line. Names in it may hold any bytes: what is
/// not UTF-8 becomes \xNN (`utf8_text`).
std::string json_text(const Json& json, int indent);

/// Reads JSON text. Error, which calls it `name`, when it is incomplete, no JSON, or nested deeper
/// than any file of this program.
Result<Json> parse_json(std::string_view text, const std::string& name);

}  // namespace aims
