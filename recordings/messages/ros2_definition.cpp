// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/ros2_definition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/messages/message_definition.hpp"

namespace aims {
namespace {

constexpr std::string_view kTime = "builtin_interfaces/Time";
constexpr std::string_view kDuration = "builtin_interfaces/Duration";

bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }

/// `K` becomes `k`, `timeRef` becomes `time_ref`.
std::string field_name(std::string_view name) {
  std::string lower;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool starts_word = i > 0 && is_upper(name[i]) && !is_upper(name[i - 1]);
    if (starts_word && name[i - 1] != '_') lower += '_';
    lower += static_cast<char>(std::tolower(static_cast<unsigned char>(name[i])));
  }
  return lower;
}

std::string type_name(const std::string& name) {
  return name == "tf/tfMessage" ? "tf2_msgs/TFMessage" : name;
}

std::string value_of(const ConstantDefinition& constant) {
  if (constant.type == "bool") {
    const bool off =
        constant.value == "0" || constant.value == "false" || constant.value == "False";
    return off ? "false" : "true";
  }
  if (constant.type != "string") return constant.value;
  std::string quoted = "\"";
  for (const char c : constant.value) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

/// Writes a type and all types that it uses.
class DefinitionWriter {
 public:
  explicit DefinitionWriter(const std::vector<TypeDefinition>& types) : types_(types) {}

  Result<std::string> write() {
    std::string text;
    order_ = {0};
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const auto section = section_of(types_[order_[i]]);
      if (!section) return section;
      if (i > 0) text += heading(type_name(types_[order_[i]].name));
      text += *section;
    }
    for (const std::string_view time : times_)
      text += heading(time) + "int32 sec\nuint32 nanosec\n";
    return text;
  }

 private:
  static std::string heading(std::string_view type) {
    return std::string(80, '=') + fmt::format("\nMSG: {}\n", type);
  }

  /// The type of a field or constant; the definitions of others are written later.
  std::string named(const std::string& type, const std::string& user) {
    if (type == "byte") return "int8";
    if (type == "char") return "uint8";
    if (type == "time" || type == "duration") {
      return std::string(*times_.insert(type == "time" ? kTime : kDuration).first);
    }
    const auto used = find_type(types_, type, user);
    if (!used) return type;
    if (std::ranges::find(order_, *used) == order_.end()) order_.push_back(*used);
    return type_name(types_[*used].name);
  }

  Result<std::string> section_of(const TypeDefinition& type) {
    std::string text;
    for (const ConstantDefinition& constant : type.constants) {
      std::string name = constant.name;
      std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::toupper(c); });
      text += fmt::format("{} {}={}\n", named(constant.type, type.name), name, value_of(constant));
    }
    std::set<std::string> names;
    for (const FieldDefinition& field : type.fields) {
      if (type.name == kHeaderType && field.name == kSequenceField) continue;
      const std::string name = field_name(field.name);
      if (!names.insert(name).second) {
        return failure(fmt::format("{}: ROS 2 cannot hold two fields named '{}'", type.name, name));
      }
      const std::string count = field.array == ArrayKind::kFixed ? std::to_string(field.count) : "";
      text += named(field.type, type.name);
      if (field.array != ArrayKind::kNone) text += '[' + count + ']';
      text += ' ' + name + '\n';
    }
    return text;
  }

  const std::vector<TypeDefinition>& types_;
  std::vector<std::size_t> order_;
  std::set<std::string_view> times_;
};

}  // namespace

Result<MessageType> ros2_type(const MessageType& ros1) {
  const auto types = parse_definition(ros1.name, ros1.definition, ros1.format.language);
  if (!types) return tl::unexpected(types.error());
  auto text = DefinitionWriter(*types).write();
  if (!text) return tl::unexpected(text.error());
  return MessageType{type_name(types->front().name), "", std::move(*text), kRos2Format};
}

}  // namespace aims
