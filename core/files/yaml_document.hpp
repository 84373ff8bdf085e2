// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
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

/// Prepends the position to a message that begins with a dotted key ("route.points.0: ..."):
/// "file:line:column: " of the key, or of the nearest group around it that the file or one of its
/// bases has; "file: " when none has any part of it. `named` is as of `load_config`.
std::string with_position(const std::filesystem::path& file, const std::string& message,
                          const std::filesystem::path& named = {});

/// Bytes of the largest YAML text that is read.
inline constexpr std::size_t kLargestYaml = std::size_t{512} << 10;

/// Refuses YAML text that would cost the parser far more memory than any configuration needs: above
/// `kLargestYaml`, or of some length with brackets or list marks nested more than a hundred deep.
/// Errors: "name:line: ...".
Result<void> check_yaml_size(std::string_view text, const std::string& name);

}  // namespace aims
