// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "recordings/messages/message_type.hpp"

namespace aims {

inline constexpr std::string_view kHeaderType = "std_msgs/Header";
/// Field of a header that ROS 1 alone has.
inline constexpr std::string_view kSequenceField = "seq";

enum class ArrayKind { kNone, kFixed, kVariable };

/// A field as written: "float64[36] covariance".
struct FieldDefinition {
  std::string type;  ///< without brackets and bounds
  std::string name;
  ArrayKind array = ArrayKind::kNone;
  std::uint32_t count = 1;  ///< entries of a fixed array
  int line = 0;             ///< in the text, from 1
};

/// A constant as written: "uint8 FLOAT32=7".
struct ConstantDefinition {
  std::string type;
  std::string name;
  std::string value;  ///< a text with the quotes that it was written with
};

/// A message type as written; default values are left out.
struct TypeDefinition {
  std::string name;  ///< with package
  std::vector<FieldDefinition> fields;
  std::vector<ConstantDefinition> constants;
};

/// "package/Type" of "package/msg/Type", as ROS 2 writes it; other names as they are.
std::string plain_type_name(std::string_view name);

/// "package/msg/Type" of "package/Type".
std::string ros2_type_name(std::string_view plain);

/// Parses a definition text: the type itself first, then the types that it uses, each after a line
/// of '=' and "MSG: package/Type"; or OMG IDL, see parse_idl(). Type names are plain. Errors name
/// the type and the line.
Result<std::vector<TypeDefinition>> parse_definition(
    std::string_view type, std::string_view text,
    DefinitionLanguage language = DefinitionLanguage::kRos1Msg);

/// The place in `types` of the type that `user` calls `name`; the first type is none that others
/// use. A name without a package belongs to the package of `user`; "Header" belongs to std_msgs.
/// Without such a type, the only type of that name is taken.
std::optional<std::size_t> find_type(const std::vector<TypeDefinition>& types,
                                     const std::string& name, const std::string& user);

}  // namespace aims
