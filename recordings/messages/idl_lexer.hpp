// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string_view>

namespace aims {

enum class IdlTokenKind {
  kName,        ///< also of a keyword
  kNumber,      ///< without sign
  kText,        ///< between double quotes
  kCharacter,   ///< between single quotes
  kSign,        ///< "::" or one character
  kSection,     ///< a line of '=' and the line behind it, which names a type
  kUnreadable,  ///< what no definition holds: a text or a comment without end, a directive
  kEnd,
};

struct IdlToken {
  IdlTokenKind kind = IdlTokenKind::kEnd;
  std::string_view text;  ///< as written, with quotes
  int line = 0;           ///< from 1
};

/// Splits OMG IDL (4.2, section 7.2) into words and signs. Comments are left out, and the
/// directives of the preprocessor that leave all as it is: includes, pragmas and guards.
class IdlLexer {
 public:
  explicit IdlLexer(std::string_view text) : text_(text) {}
  IdlToken next();

 private:
  bool skip_blanks_and_comments();
  bool skip_directive();
  IdlToken section();
  IdlToken quoted(char quote);
  IdlToken take(IdlTokenKind kind, std::size_t size);
  std::string_view line_at(std::size_t place) const;
  std::string_view rest() const { return text_.substr(place_); }

  std::string_view text_;
  std::size_t place_ = 0;
  int line_ = 1;
  bool at_line_start_ = true;
};

}  // namespace aims
