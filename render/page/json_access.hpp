// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "bench/run/score_record.hpp"
#include "core/error.hpp"

namespace aims {

/// The member of that key; null when `json` is no object or has none.
const Json& member(const Json& json, const std::string& key);

/// The text of that key; empty when it is no text.
std::string text_in(const Json& json, const std::string& key);

/// The finite number of that key; none when it is none.
std::optional<double> number_in(const Json& json, const std::string& key);

/// Reads a JSON document of that schema. Error with the file and what was expected.
Result<Json> read_json_of(const std::filesystem::path& file, std::string_view schema);

/// The last part of a folder's path, as its name in titles; "." and links are followed.
std::string folder_name(const std::filesystem::path& folder);

}  // namespace aims
