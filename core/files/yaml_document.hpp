// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace YAML {
class Node;
struct Mark;
}  // namespace YAML

namespace aims {

/// The key of the file that a file is based on.
inline constexpr std::string_view kBaseKey = "base";

/// "file:line:column" of a mark; the file alone when the parser left no mark.
std::string place(const std::string& file, const YAML::Mark& mark);

/// What a node is, for messages: "a map", "a list", "nothing", "'text'".
std::string kind_of(const YAML::Node& node);

/// The one document of a text, which must be a map. Errors name the file, line and column.
Result<YAML::Node> parse_document(const std::string& text, const std::string& file);

/// The value of a setting, in YAML's form on one line. Errors name the setting.
Result<YAML::Node> parse_value(const std::string& text, const std::string& setting);

/// The file that `base: GIVEN` in `file` means: a path relative to `file`, or a bare name:
/// NAME.yaml beside `file`, else the one in `named` and below. `file` itself is not found by its
/// bare name. Error for none, and for two in `named`.
Result<std::filesystem::path> find_base(const std::filesystem::path& file, const std::string& given,
                                        const std::filesystem::path& named);

}  // namespace aims
