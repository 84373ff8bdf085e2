// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "recordings/messages/message_definition.hpp"

namespace aims {

/// Parses a definition in OMG IDL as ROS 2 makes it: the type itself, then the types that it uses,
/// each behind a line of '=' and "IDL: package/msg/Type". Types are named as in a .msg, the type
/// itself comes first; what typedef names is put in the place of its name, an array of several
/// dimensions is one row by row, and constants of `package::msg::Type_Constants` are those of
/// `package/Type`. Errors begin with "line N: ".
Result<std::vector<TypeDefinition>> parse_idl(const std::string& type, std::string_view text);

}  // namespace aims
