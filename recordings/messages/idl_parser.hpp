// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// A type as written in OMG IDL, before names are looked up.
struct IdlType {
  std::string
      name;  ///< as a .msg has it if `basic`; else as written, e.g. "geometry_msgs::msg::Pose"
  bool basic = false;
  bool sequence = false;
  std::vector<std::string> sizes;  ///< of an array: numbers above 0, or names of constants
  std::string scope;               ///< in which it is written, e.g. "sensor_msgs::msg"
  int line = 0;

  /// Whether both mean the same, wherever they are written in their scope.
  bool is_as(const IdlType& other) const;
};

struct IdlMember {
  IdlType type;
  std::string name;
};

struct IdlStruct {
  std::string name;  ///< with its scopes, e.g. "sensor_msgs::msg::Imu"
  std::vector<IdlMember> members;
  int line = 0;
};

struct IdlConstant {
  IdlType type;
  std::string value;  ///< a text with its quotes
};

/// What a text declares; keys are names with their scopes.
struct IdlDeclarations {
  std::vector<IdlStruct> structs;
  std::map<std::string, IdlType> aliases;  ///< of typedef; enumerations, whose values are uint32
  std::map<std::string, IdlConstant> constants;
  std::vector<std::string> constant_order;  ///< keys, as written
};

/// Parses the part of OMG IDL of which ROS 2 makes message definitions: modules, structures,
/// arrays, sequences, texts, basic types by their old and new names, typedef, constants and
/// enumerations. Annotations are left out, those that change how a value is serialized refused.
/// Errors begin with "line N: ".
Result<IdlDeclarations> parse_idl_declarations(std::string_view text);

}  // namespace aims
