// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/message_definition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

namespace aims {
namespace {

constexpr std::size_t kMaxNameBytes = 128;
constexpr std::size_t kMaxTypes = 512;
constexpr std::size_t kMaxFields = 4096;
constexpr std::string_view kBlank = " \t\r\f\v";
constexpr std::string_view kSectionWord = "MSG:";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_name_character(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; }

bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= kMaxNameBytes && is_letter(text[0]) &&
         std::all_of(text.begin(), text.end(), is_name_character);
}

bool is_type_name(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return is_name(text);
  return is_name(text.substr(0, slash)) && is_name(text.substr(slash + 1));
}

/// A line between two sections: three '=' or more, and nothing else.
bool is_separator(std::string_view line) {
  return line.size() >= 3 && line.find_first_not_of('=') == std::string_view::npos;
}

/// Splits "[]" or "[36]" off the type; false when the brackets are malformed.
bool split_array(std::string_view word, FieldDefinition& field) {
  const std::size_t bracket = word.find('[');
  field.type = word.substr(0, bracket);
  if (bracket == std::string_view::npos) return true;
  if (!word.ends_with(']')) return false;
  const std::string_view count = word.substr(bracket + 1, word.size() - bracket - 2);
  field.array = count.empty() ? ArrayKind::kVariable : ArrayKind::kFixed;
  if (count.empty()) return true;
  const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), field.count);
  return error == std::errc() && end == count.data() + count.size() && field.count > 0;
}

/// The field of a line without comment.
Result<FieldDefinition> parse_field(std::string_view line) {
  const std::size_t gap = line.find_first_of(kBlank);
  const std::string_view shown = line.substr(0, 80);
  if (gap == std::string_view::npos) {
    return failure(fmt::format("expected 'TYPE NAME', found '{}'", shown));
  }
  FieldDefinition field;
  field.name = trimmed(line.substr(gap));
  if (!split_array(line.substr(0, gap), field) || !is_type_name(field.type) ||
      !is_name(field.name)) {
    return failure(fmt::format("expected 'TYPE NAME', found '{}'", shown));
  }
  return field;
}

/// A constant has a '=' before any comment.
bool is_constant(std::string_view line) {
  const std::size_t equals = line.find('=');
  return equals != std::string_view::npos && equals < line.find('#') && equals > 0;
}

Result<void> add_field(std::string_view line, int number, TypeDefinition& type) {
  // A constant looks like a field up to its '='; its value may contain a '#'.
  const bool constant = is_constant(line);
  line = trimmed(line.substr(0, line.find(constant ? '=' : '#')));
  if (line.empty()) return {};
  auto field = parse_field(line);
  if (!field) return tl::unexpected(field.error());
  if (constant && field->array == ArrayKind::kNone) return {};
  if (constant) return failure(fmt::format("expected 'TYPE NAME', found '{}'", line.substr(0, 80)));
  if (type.fields.size() >= kMaxFields) {
    return failure(fmt::format("a type of more than {} fields", kMaxFields));
  }
  field->line = number;
  type.fields.push_back(std::move(*field));
  return {};
}

}  // namespace

Result<std::vector<TypeDefinition>> parse_definition(std::string_view type, std::string_view text) {
  const auto refuse = [&](int line, const std::string& what) {
    return failure(fmt::format("definition of '{}', line {}: {}", type.substr(0, 80), line, what));
  };
  if (!is_type_name(type)) return refuse(1, "expected a type's name 'package/Type'");
  std::vector<TypeDefinition> types;
  types.push_back({std::string(type), {}});
  bool expect_name = false;
  int number = 0;
  while (!text.empty()) {
    ++number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (is_separator(line)) {
      expect_name = true;
    } else if (expect_name && line.starts_with(kSectionWord)) {
      const std::string_view name = trimmed(line.substr(kSectionWord.size()));
      if (!is_type_name(name)) return refuse(number, "expected 'MSG: package/Type'");
      if (types.size() >= kMaxTypes) return refuse(number, "too many types");
      types.push_back({std::string(name), {}});
      expect_name = false;
    } else if (expect_name && !line.empty()) {
      return refuse(number, "expected 'MSG: package/Type'");
    } else {
      const auto added = add_field(line, number, types.back());
      if (!added) return refuse(number, added.error().message);
    }
  }
  return types;
}

}  // namespace aims
