// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/idl_definition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "recordings/messages/definition_words.hpp"
#include "recordings/messages/idl_parser.hpp"

namespace aims {
namespace {

constexpr int kMaxAliases = 16;
constexpr std::string_view kConstantsSuffix = "_Constants";
/// Types that decoding has built in.
constexpr std::array<std::string_view, 2> kGivenTypes = {"builtin_interfaces/Time",
                                                         "builtin_interfaces/Duration"};

/// "package/Type" of "package::msg::Type".
std::string plain_name(std::string_view scoped) {
  std::string name;
  for (std::size_t i = 0; i < scoped.size(); ++i) {
    if (scoped[i] != ':') {
      name += scoped[i];
    } else if (!name.empty() && name.back() != '/') {
      name += '/';
    }
  }
  return plain_type_name(name);
}

tl::unexpected<Error> refuse_idl(int line, const std::string& what) {
  return failure(fmt::format("line {}: {}", line, what));
}

/// Looks names up, from the innermost module outwards.
class IdlResolver {
 public:
  explicit IdlResolver(const IdlDeclarations& declared) : declared_(declared) {
    for (const IdlStruct& each : declared.structs) structs_.insert(each.name);
  }

  Result<TypeDefinition> type_of(const IdlStruct& found) const {
    TypeDefinition type{plain_name(found.name), {}, {}};
    for (const IdlMember& member : found.members) {
      auto field = field_of(member.type, 0);
      if (!field) return tl::unexpected(field.error());
      field->name = member.name;
      field->line = member.type.line;
      type.fields.push_back(std::move(*field));
    }
    return type;
  }

  /// The type of a field or constant, without its name.
  Result<FieldDefinition> field_of(const IdlType& type, int depth) const {
    auto field = named_type(type, depth);
    if (!field) return field;
    if (type.sequence) {
      if (field->array != ArrayKind::kNone) {
        return refuse_idl(type.line, fmt::format("a sequence of '{}', which is an array or "
                                                 "sequence itself: expected a sequence of single "
                                                 "values or structures",
                                                 type.name));
      }
      field->array = ArrayKind::kVariable;
    }
    for (const std::string& size : type.sizes) {
      const auto count = count_of(size, type);
      if (!count) return tl::unexpected(count.error());
      if (field->array == ArrayKind::kVariable) {
        return refuse_idl(type.line,
                          "an array of sequences: expected an array of single values "
                          "or structures");
      }
      const std::uint64_t product = std::uint64_t{field->count} * *count;
      if (product > std::numeric_limits<std::uint32_t>::max()) {
        return refuse_idl(type.line, "an array of more than 2^32 - 1 entries");
      }
      field->array = ArrayKind::kFixed;
      field->count = static_cast<std::uint32_t>(product);
    }
    return field;
  }

 private:
  /// The name with its scopes under which `declared` has it, or nothing.
  template <class Names>
  static std::optional<std::string> find_name(const Names& declared, const std::string& name,
                                              std::string scope) {
    if (name.starts_with("::")) {
      std::string absolute = name.substr(2);
      return declared.contains(absolute) ? std::optional(std::move(absolute)) : std::nullopt;
    }
    while (true) {
      std::string inner = scope.empty() ? name : scope + "::" + name;
      if (declared.contains(inner)) return inner;
      if (scope.empty()) return std::nullopt;
      const std::size_t outer = scope.rfind("::");
      scope.resize(outer == std::string::npos ? 0 : outer);
    }
  }

  /// The type without the sequence and the sizes that are written with it.
  Result<FieldDefinition> named_type(const IdlType& type, int depth) const {
    FieldDefinition field;
    field.type = type.name;
    if (type.basic) return field;
    if (depth > kMaxAliases) {
      return refuse_idl(type.line, fmt::format("'{}' is a typedef of itself, or one of more than "
                                               "{} others",
                                               type.name, kMaxAliases));
    }
    if (const auto alias = find_name(declared_.aliases, type.name, type.scope)) {
      return field_of(declared_.aliases.at(*alias), depth + 1);
    }
    if (const auto found = find_name(structs_, type.name, type.scope)) {
      field.type = plain_name(*found);
      return field;
    }
    field.type = plain_name(type.name);
    if (std::ranges::find(kGivenTypes, field.type) != kGivenTypes.end()) return field;
    return refuse_idl(type.line, fmt::format("unknown type '{}': expected a basic type or one that "
                                             "the definition holds",
                                             type.name));
  }

  Result<std::uint32_t> count_of(const std::string& size, const IdlType& type) const {
    const auto constant = find_name(declared_.constants, size, type.scope);
    const std::string& digits = constant ? declared_.constants.at(*constant).value : size;
    if (const auto count = count_in(digits)) return *count;
    return refuse_idl(type.line, fmt::format("expected a whole number above 0 or a constant that "
                                             "is one as the size of an array, found '{}'",
                                             size));
  }

  const IdlDeclarations& declared_;
  std::set<std::string> structs_;
};

/// Puts the constants of a module `Type_Constants` into `Type`.
Result<void> add_constants(const IdlDeclarations& declared, const IdlResolver& resolver,
                           std::vector<TypeDefinition>& types) {
  for (const std::string& key : declared.constant_order) {
    const std::size_t end = key.rfind("::");
    if (end == std::string::npos || !key.substr(0, end).ends_with(kConstantsSuffix)) continue;
    const std::string user = plain_name(key.substr(0, end - kConstantsSuffix.size()));
    const auto type = std::ranges::find(types, user, &TypeDefinition::name);
    if (type == types.end()) continue;
    const IdlConstant& constant = declared.constants.at(key);
    const auto field = resolver.field_of(constant.type, 0);
    if (!field) return tl::unexpected(field.error());
    type->constants.push_back({field->type, key.substr(end + 2), constant.value});
  }
  return {};
}

}  // namespace

Result<std::vector<TypeDefinition>> parse_idl(const std::string& type, std::string_view text) {
  const auto declared = parse_idl_declarations(text);
  if (!declared) return tl::unexpected(declared.error());
  const IdlResolver resolver(*declared);
  std::vector<TypeDefinition> types;
  for (const IdlStruct& each : declared->structs) {
    auto found = resolver.type_of(each);
    if (!found) return tl::unexpected(found.error());
    if (std::ranges::find(types, found->name, &TypeDefinition::name) != types.end()) {
      return refuse_idl(each.line, fmt::format("'{}' is defined twice", found->name));
    }
    types.push_back(std::move(*found));
  }
  const auto root = std::ranges::find(types, type, &TypeDefinition::name);
  if (root == types.end()) {
    return refuse_idl(1, fmt::format("expected a struct '{}' in its module", ros2_type_name(type)));
  }
  std::rotate(types.begin(), root, root + 1);
  if (auto added = add_constants(*declared, resolver, types); !added) {
    return tl::unexpected(added.error());
  }
  return types;
}

}  // namespace aims
