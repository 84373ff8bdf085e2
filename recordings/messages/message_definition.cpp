// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/message_definition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/text.hpp"
#include "recordings/messages/definition_words.hpp"
#include "recordings/messages/idl_definition.hpp"

namespace aims {
namespace {

constexpr std::string_view kSectionWord = "MSG:";

bool is_type_name(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return is_name(text);
  return is_name(text.substr(0, slash)) && is_name(text.substr(slash + 1));
}

/// Removes the bound of "string<=10"; false when it is malformed.
bool drop_bound(std::string& type) {
  const std::size_t bound = type.find("<=");
  if (bound == std::string::npos) return true;
  const bool of_text = type.starts_with("string<") || type.starts_with("wstring<");
  const bool counted = count_in(std::string_view(type).substr(bound + 2)).has_value();
  type.resize(bound);
  return of_text && counted;
}

/// Splits "[]", "[36]" or, in ROS 2, "[<=36]" off the type; false when the brackets are malformed.
bool split_array(std::string_view word, bool bounds, FieldDefinition& field) {
  const std::size_t bracket = word.find('[');
  field.type = word.substr(0, bracket);
  if (bounds && !drop_bound(field.type)) return false;
  field.type = plain_type_name(field.type);
  if (bracket == std::string_view::npos) return true;
  if (!word.ends_with(']')) return false;
  std::string_view count = word.substr(bracket + 1, word.size() - bracket - 2);
  const bool bounded = bounds && count.starts_with("<=");
  if (bounded) count.remove_prefix(2);
  field.array = count.empty() || bounded ? ArrayKind::kVariable : ArrayKind::kFixed;
  if (count.empty()) return !bounded;
  const auto entries = count_in(count);
  if (!entries) return false;
  field.count = bounded ? 1 : *entries;
  return true;
}

tl::unexpected<Error> expected_field(std::string_view line) {
  return failure(fmt::format("expected 'TYPE NAME', found '{}'", line.substr(0, 80)));
}

/// The field of a line without comment.
Result<FieldDefinition> parse_field(std::string_view line, bool bounds) {
  const std::size_t gap = line.find_first_of(kBlank);
  if (gap == std::string_view::npos) return expected_field(line);
  FieldDefinition field;
  field.name = trimmed(line.substr(gap), kBlank);
  if (!split_array(line.substr(0, gap), bounds, field) || !is_type_name(field.type) ||
      !is_name(field.name)) {
    return expected_field(line);
  }
  return field;
}

/// Where the '=' of a constant is: before any comment, and not that of a bound.
std::size_t constant_sign(std::string_view line) {
  std::size_t equals = line.find('=');
  while (equals != std::string_view::npos && equals > 0 && line[equals - 1] == '<') {
    equals = line.find('=', equals + 1);
  }
  const bool found = equals != std::string_view::npos && equals < line.find('#') && equals > 0;
  return found ? equals : std::string_view::npos;
}

/// The line up to the end of the second word: ROS 2 lets a default value follow.
std::string_view without_default(std::string_view line) {
  const std::size_t gap = line.find_first_of(kBlank);
  if (gap == std::string_view::npos) return line;
  const std::size_t name = line.find_first_not_of(kBlank, gap);
  return line.substr(0, line.find_first_of(kBlank, name));
}

/// The value of a constant: a text reaches to the end of the line, with any '#'.
std::string value_in(std::string_view text, std::string_view type) {
  const bool is_text = type == "string" || type == "wstring";
  return std::string(trimmed(is_text ? text : text.substr(0, text.find('#')), kBlank));
}

/// Adds the field or the constant of a line.
Result<void> add_line(std::string_view line, int number, bool ros2, TypeDefinition& type) {
  const std::size_t sign = constant_sign(line);
  const bool constant = sign != std::string_view::npos;
  std::string_view declared = trimmed(line.substr(0, constant ? sign : line.find('#')), kBlank);
  if (declared.empty()) return {};
  // The name of a default text may hold a '=': "string frame "a=b"".
  const bool has_default = ros2 && without_default(declared).size() < declared.size();
  if (has_default) declared = without_default(declared);
  auto field = parse_field(declared, ros2);
  if (!field) return tl::unexpected(field.error());
  if (constant && !has_default) {
    if (field->array != ArrayKind::kNone) return expected_field(declared);
    type.constants.push_back(
        {field->type, field->name, value_in(line.substr(sign + 1), field->type)});
    return {};
  }
  if (type.fields.size() >= kMaxDefinedFields) {
    return failure(fmt::format("a type of more than {} fields", kMaxDefinedFields));
  }
  field->line = number;
  type.fields.push_back(std::move(*field));
  return {};
}

}  // namespace

std::string plain_type_name(std::string_view name) {
  const std::size_t slash = name.find("/msg/");
  if (slash == std::string_view::npos) return std::string(name);
  return fmt::format("{}/{}", name.substr(0, slash), name.substr(slash + 5));
}

std::string ros2_type_name(std::string_view plain) {
  const std::size_t slash = plain.find('/');
  if (slash == std::string_view::npos) return std::string(plain);
  return fmt::format("{}/msg{}", plain.substr(0, slash), plain.substr(slash));
}

Result<std::vector<TypeDefinition>> parse_definition(std::string_view given, std::string_view text,
                                                     DefinitionLanguage language) {
  const std::string type = plain_type_name(given);
  const bool ros2 = language != DefinitionLanguage::kRos1Msg;
  const auto refuse = [&](int line, const std::string& what) {
    return failure(fmt::format("definition of '{}', line {}: {}", type.substr(0, 80), line, what));
  };
  if (!is_type_name(type)) return refuse(1, "expected a type's name 'package/Type'");
  if (language == DefinitionLanguage::kRos2Idl) {
    auto types = parse_idl(type, text);
    if (types) return types;
    return failure(
        fmt::format("definition of '{}', {}", type.substr(0, 80), types.error().message));
  }
  std::vector<TypeDefinition> types;
  types.push_back({type, {}, {}});
  bool expect_name = false;
  int number = 0;
  while (!text.empty()) {
    ++number;
    const std::string_view line = trimmed(take_until(text, '\n'), kBlank);
    if (is_separator(line)) {
      expect_name = true;
    } else if (expect_name && line.starts_with(kSectionWord)) {
      const std::string name = plain_type_name(trimmed(line.substr(kSectionWord.size()), kBlank));
      if (!is_type_name(name)) return refuse(number, "expected 'MSG: package/Type'");
      if (types.size() >= kMaxDefinedTypes) return refuse(number, "too many types");
      types.push_back({name, {}, {}});
      expect_name = false;
    } else if (expect_name && !line.empty()) {
      return refuse(number, "expected 'MSG: package/Type'");
    } else {
      const auto added = add_line(line, number, ros2, types.back());
      if (!added) return refuse(number, added.error().message);
    }
  }
  return types;
}

std::optional<std::size_t> find_type(const std::vector<TypeDefinition>& types,
                                     const std::string& name, const std::string& user) {
  const bool bare = name.find('/') == std::string::npos;
  const std::string package = user.substr(0, user.find('/'));
  std::string wanted = name;
  if (bare) wanted = name == "Header" ? kHeaderType : package + "/" + name;
  std::optional<std::size_t> alike;
  for (std::size_t i = 1; i < types.size(); ++i) {
    if (types[i].name == wanted) return i;
    if (bare && types[i].name.ends_with("/" + name)) {
      if (alike) return std::nullopt;
      alike = i;
    }
  }
  return alike;
}

}  // namespace aims
