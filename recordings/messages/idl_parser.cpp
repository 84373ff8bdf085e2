// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/idl_parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "core/text.hpp"
#include "recordings/messages/definition_words.hpp"
#include "recordings/messages/idl_lexer.hpp"

namespace aims {
namespace {

constexpr int kMaxModules = 16;
constexpr std::size_t kMaxDeclarations = 8 * kMaxDefinedFields;

/// Basic types of one word, and how a .msg calls them.
constexpr auto kBasicTypes = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"boolean", "bool"},
    {"octet", "byte"},
    {"char", "char"},
    {"wchar", "wchar"},
    {"int8", "int8"},
    {"uint8", "uint8"},
    {"int16", "int16"},
    {"uint16", "uint16"},
    {"int32", "int32"},
    {"uint32", "uint32"},
    {"int64", "int64"},
    {"uint64", "uint64"},
    {"float", "float32"},
    {"double", "float64"},
    {"string", "string"},
    {"wstring", "wstring"},
});

/// Annotations of members or types whose values are not serialized as those of others.
constexpr std::array<std::string_view, 4> kLayoutAnnotations = {"optional", "mutable", "bit_bound",
                                                                "non_serialized"};

/// Reads token by token; the first thing that does not fit is the error, and ends all loops.
class IdlParser {
 public:
  explicit IdlParser(std::string_view text) : lexer_(text) { advance(); }

  Result<IdlDeclarations> parse() {
    while (!error_ && token_.kind != IdlTokenKind::kEnd) {
      if (token_.kind == IdlTokenKind::kSection) {
        section();
      } else {
        definition();
      }
    }
    if (error_) return tl::unexpected(std::move(*error_));
    return std::move(declared_);
  }

 private:
  void advance() { token_ = lexer_.next(); }
  bool refuse_at(int line, const std::string& what) {
    if (!error_) error_ = Error{fmt::format("line {}: {}", line, what)};
    return false;
  }
  bool refuse(std::string_view expected) {
    const bool end = token_.kind == IdlTokenKind::kEnd;
    const std::string found = end ? "the end" : fmt::format("'{}'", token_.text.substr(0, 80));
    return refuse_at(token_.line, fmt::format("expected {}, found {}", expected, found));
  }
  bool is(std::string_view word) const {
    const bool plain = token_.kind == IdlTokenKind::kName || token_.kind == IdlTokenKind::kSign;
    return plain && token_.text == word;
  }
  bool accept(std::string_view word) {
    if (error_ || !is(word)) return false;
    advance();
    return true;
  }
  bool expect(std::string_view word) {
    return !error_ && (accept(word) || refuse(fmt::format("'{}'", word)));
  }

  void section();
  void definition();
  void module();
  void structure();
  void alias();
  void constant();
  void enumeration();
  bool annotations();
  bool annotation_arguments(std::string_view name);
  bool take_name(std::string& name);
  bool scoped_name(std::string& name);
  bool type(IdlType& type);
  bool element(IdlType& type);
  bool number_words(IdlType& type);
  bool size(std::string& size);
  bool bound();
  bool declarators(const IdlType& type, std::vector<IdlMember>& members);
  bool constant_value(std::string& value);
  bool add_constant(const std::string& name, IdlConstant constant);
  bool add_alias(const std::string& name, IdlType type, int line);
  std::string scoped(const std::string& name) const {
    return scope_.empty() ? name : scope_ + "::" + name;
  }

  IdlLexer lexer_;
  IdlToken token_;
  std::string scope_;
  int modules_ = 0;
  std::size_t members_ = 0;
  IdlDeclarations declared_;
  std::optional<Error> error_;
};

/// The types that others use follow behind a line of '=' and "IDL: package/msg/Type".
void IdlParser::section() {
  const std::string_view line = trimmed(token_.text, kBlank);
  if (!line.starts_with("IDL:")) {
    refuse("'IDL: package/msg/Type'");
    return;
  }
  advance();
}

void IdlParser::definition() {
  if (!annotations()) return;
  if (accept("module")) {
    module();
  } else if (accept("struct")) {
    structure();
  } else if (accept("typedef")) {
    alias();
  } else if (accept("const")) {
    constant();
  } else if (accept("enum")) {
    enumeration();
  } else {
    refuse("module, struct, typedef, const or enum");
  }
}

void IdlParser::module() {
  std::string name;
  if (!take_name(name) || !expect("{")) return;
  if (++modules_ > kMaxModules) {
    refuse_at(token_.line, fmt::format("modules nested deeper than {}", kMaxModules));
    return;
  }
  const std::string outer = std::exchange(scope_, scoped(name));
  while (!error_ && !is("}")) definition();
  scope_ = outer;
  --modules_;
  if (expect("}")) expect(";");
}

void IdlParser::structure() {
  IdlStruct found;
  found.line = token_.line;
  if (!take_name(found.name) || accept(";")) return;  // announced only
  found.name = scoped(found.name);
  if (!expect("{")) return;
  while (!error_ && !is("}")) {
    IdlType each;
    if (!annotations() || !type(each) || !declarators(each, found.members)) return;
    if (found.members.size() > kMaxDefinedFields) {
      refuse_at(each.line, fmt::format("a type of more than {} fields", kMaxDefinedFields));
    }
  }
  if (!expect("}") || !expect(";")) return;
  if (std::ranges::find(declared_.structs, found.name, &IdlStruct::name) !=
      declared_.structs.end()) {
    refuse_at(found.line, fmt::format("'{}' is defined twice", found.name));
  } else if (declared_.structs.size() >= kMaxDefinedTypes) {
    refuse_at(found.line, "too many types");
  }
  declared_.structs.push_back(std::move(found));
}

void IdlParser::alias() {
  IdlType meant;
  std::vector<IdlMember> names;
  if (!type(meant) || !declarators(meant, names)) return;
  for (IdlMember& each : names) add_alias(scoped(each.name), std::move(each.type), meant.line);
}

/// The files of a package repeat the same typedef: "double double__9[9]".
bool IdlParser::add_alias(const std::string& name, IdlType type, int line) {
  if (declared_.aliases.size() >= kMaxDeclarations) return refuse_at(line, "too many types");
  const auto [place, added] = declared_.aliases.try_emplace(name, std::move(type));
  if (added || place->second.is_as(type)) return true;
  return refuse_at(line, fmt::format("'{}' is defined twice, differently", name));
}

void IdlParser::constant() {
  IdlConstant found;
  std::string name;
  if (!type(found.type) || !take_name(name) || !expect("=") || !constant_value(found.value)) return;
  if (expect(";")) add_constant(name, std::move(found));
}

bool IdlParser::add_constant(const std::string& name, IdlConstant constant) {
  const int line = constant.type.line;
  if (declared_.constants.size() >= kMaxDeclarations) return refuse_at(line, "too many constants");
  const auto [place, added] = declared_.constants.try_emplace(scoped(name), constant);
  if (added) declared_.constant_order.push_back(place->first);
  if (added || (place->second.value == constant.value && place->second.type.is_as(constant.type))) {
    return true;
  }
  return refuse_at(line, fmt::format("'{}' is defined twice, differently", place->first));
}

/// A number with its sign, texts in a row, a character, or a name.
bool IdlParser::constant_value(std::string& value) {
  if (is("-") || is("+")) {
    if (is("-")) value += '-';
    advance();
    if (token_.kind != IdlTokenKind::kNumber) return refuse("a number");
  }
  if (token_.kind == IdlTokenKind::kText) {
    std::string text;
    for (; token_.kind == IdlTokenKind::kText; advance()) {
      text += token_.text.substr(1, token_.text.size() - 2);
    }
    value = '"' + text + '"';
    return true;
  }
  if (token_.kind == IdlTokenKind::kName) return scoped_name(value);
  if (token_.kind != IdlTokenKind::kNumber && token_.kind != IdlTokenKind::kCharacter) {
    return refuse("the value of a constant");
  }
  value += token_.text;
  advance();
  return true;
}

void IdlParser::enumeration() {
  IdlType number;
  number.name = "uint32";
  number.basic = true;
  number.line = token_.line;
  number.scope = scope_;
  std::string name, value;
  if (!take_name(name) || !add_alias(scoped(name), number, number.line) || !expect("{")) return;
  for (int i = 0; !error_ && (i == 0 || accept(",")); ++i) {
    number.line = token_.line;
    if (annotations() && take_name(value)) add_constant(value, {number, std::to_string(i)});
  }
  if (expect("}")) expect(";");
}

/// Passes over annotations: "@default(value=1)", "@verbatim (language="comment", text="...")".
bool IdlParser::annotations() {
  while (accept("@")) {
    std::string name;
    if (!scoped_name(name)) return false;
    if (std::ranges::find(kLayoutAnnotations, name) != kLayoutAnnotations.end()) {
      return refuse_at(token_.line, fmt::format("'@{}' changes how values are serialized: expected "
                                                "a definition without it",
                                                name));
    }
    if (is("(") && !annotation_arguments(name)) return false;
  }
  return !error_;
}

bool IdlParser::annotation_arguments(std::string_view name) {
  int open = 0;
  do {
    if (is("(")) ++open;
    if (is(")")) --open;
    const bool passable = token_.kind != IdlTokenKind::kEnd &&
                          token_.kind != IdlTokenKind::kSection &&
                          token_.kind != IdlTokenKind::kUnreadable;
    if (!passable) return refuse(fmt::format("')' of '@{}'", name));
    if (name == "extensibility" && is("MUTABLE")) return refuse("FINAL or APPENDABLE");
    advance();
  } while (open > 0);
  return true;
}

bool IdlParser::take_name(std::string& name) {
  if (error_) return false;
  // An underscore in front allows names that are keywords.
  const std::string_view text = token_.text.substr(token_.text.starts_with('_') ? 1 : 0);
  if (token_.kind != IdlTokenKind::kName || !is_name(text)) return refuse("a name");
  name = text;
  advance();
  return true;
}

bool IdlParser::scoped_name(std::string& name) {
  name = accept("::") ? "::" : "";
  for (int parts = 0; parts <= kMaxModules; ++parts) {
    std::string part;
    if (!take_name(part)) return false;
    name += part;
    if (!accept("::")) return true;
    name += "::";
  }
  return refuse(fmt::format("a name of {} parts or fewer", kMaxModules));
}

bool IdlParser::type(IdlType& type) {
  if (!accept("sequence")) return element(type);
  if (!expect("<")) return false;
  if (is("sequence")) return refuse("a type that is no sequence itself");
  if (!element(type) || (accept(",") && !bound())) return false;
  type.sequence = true;
  return expect(">");
}

bool IdlParser::element(IdlType& type) {
  if (error_) return false;
  type.line = token_.line;
  type.scope = scope_;
  if (is("unsigned") || is("short") || is("long")) return number_words(type);
  const auto* const found =
      std::ranges::find_if(kBasicTypes, [&](const auto& each) { return is(each.first); });
  type.basic = found != kBasicTypes.end();
  if (!type.basic) return scoped_name(type.name);
  type.name = found->second;
  advance();
  const bool text = type.name == "string" || type.name == "wstring";
  if (!text || !accept("<")) return true;
  return bound() && expect(">");
}

/// "unsigned long long" and its like.
bool IdlParser::number_words(IdlType& type) {
  type.basic = true;
  const bool is_unsigned = accept("unsigned");
  int bits = 16;
  if (!accept("short")) {
    if (!expect("long")) return false;
    if (is("double")) return refuse("a number of 64 bits or fewer");
    bits = accept("long") ? 64 : 32;
  }
  type.name = fmt::format("{}int{}", is_unsigned ? "u" : "", bits);
  return true;
}

/// A number above 0, or the name of a constant.
bool IdlParser::size(std::string& size) {
  if (token_.kind != IdlTokenKind::kNumber) return scoped_name(size);
  if (!count_in(token_.text)) return refuse("a whole number above 0");
  size = token_.text;
  advance();
  return true;
}

/// Of a sequence or a text, which bounds nothing in its bytes.
bool IdlParser::bound() {
  std::string unused;
  return size(unused);
}

/// The names of fields or types behind a type, each with the sizes of an array.
bool IdlParser::declarators(const IdlType& type, std::vector<IdlMember>& members) {
  do {
    IdlMember member{type, {}};
    if (!annotations() || !take_name(member.name)) return false;
    while (accept("[")) {
      if (!size(member.type.sizes.emplace_back()) || !expect("]")) return false;
    }
    if (++members_ > kMaxDeclarations) return refuse_at(type.line, "too many fields");
    members.push_back(std::move(member));
  } while (accept(","));
  return expect(";");
}

}  // namespace

bool IdlType::is_as(const IdlType& other) const {
  return name == other.name && basic == other.basic && sequence == other.sequence &&
         sizes == other.sizes;
}

Result<IdlDeclarations> parse_idl_declarations(std::string_view text) {
  return IdlParser(text).parse();
}

}  // namespace aims
