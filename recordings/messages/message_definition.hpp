// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace aims {

enum class ArrayKind { kNone, kFixed, kVariable };

/// A field as written: "float64[36] covariance".
struct FieldDefinition {
  std::string type;  ///< without brackets
  std::string name;
  ArrayKind array = ArrayKind::kNone;
  std::uint32_t count = 1;  ///< entries of a fixed array
  int line = 0;             ///< in the text, from 1
};

/// A message type as written, without constants.
struct TypeDefinition {
  std::string name;  ///< with package
  std::vector<FieldDefinition> fields;
};

/// Parses a definition text: the type itself first, then the types that it uses, each after a line
/// of '=' and "MSG: package/Type". Errors name the type and the line.
Result<std::vector<TypeDefinition>> parse_definition(std::string_view type, std::string_view text);

}  // namespace aims
