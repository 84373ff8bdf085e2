// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/idl_lexer.hpp"

#include <algorithm>
#include <array>

#include "core/text.hpp"
#include "recordings/messages/definition_words.hpp"

namespace aims {
namespace {

constexpr std::string_view kDigits = "0123456789";
constexpr std::string_view kNameCharacters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
/// Directives that leave the types as they are; of conditions, those around a whole file.
constexpr std::array<std::string_view, 5> kIdleDirectives = {"include", "pragma", "ifndef",
                                                             "define", "endif"};

std::size_t length_of(std::string_view text, std::string_view characters) {
  return std::min(text.find_first_not_of(characters), text.size());
}

/// Digits, letters and points, and the sign of an exponent.
std::size_t length_of_number(std::string_view text) {
  std::size_t size = 0;
  while (size < text.size()) {
    const bool sign = size > 0 && (text[size] == '+' || text[size] == '-') &&
                      (text[size - 1] == 'e' || text[size - 1] == 'E');
    const bool part = text[size] == '.' || kNameCharacters.find(text[size]) != text.npos;
    if (!sign && !part) break;
    ++size;
  }
  return size;
}

}  // namespace

std::string_view IdlLexer::line_at(std::size_t place) const {
  const std::string_view behind = text_.substr(std::min(place, text_.size()));
  return behind.substr(0, behind.find('\n'));
}

IdlToken IdlLexer::take(IdlTokenKind kind, std::size_t size) {
  const IdlToken token{kind, text_.substr(place_, size), line_};
  line_ += static_cast<int>(std::ranges::count(token.text, '\n'));
  place_ += token.text.size();
  at_line_start_ = false;
  return token;
}

/// False before a comment without end.
bool IdlLexer::skip_blanks_and_comments() {
  while (place_ < text_.size()) {
    const char c = text_[place_];
    if (c == '\n') {
      ++place_;
      ++line_;
      at_line_start_ = true;
    } else if (c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v') {
      ++place_;
    } else if (rest().starts_with("//")) {
      place_ += line_at(place_).size();
    } else if (rest().starts_with("/*")) {
      const std::size_t end = rest().find("*/", 2);
      if (end == std::string_view::npos) return false;
      const bool line_start = at_line_start_;
      take(IdlTokenKind::kUnreadable, end + 2);
      at_line_start_ = line_start;
    } else {
      return true;
    }
  }
  return true;
}

/// False before a directive that decides what a definition is.
bool IdlLexer::skip_directive() {
  const std::string_view line = line_at(place_);
  const std::string_view words = trimmed(line.substr(1), kBlank);
  const std::string_view word = words.substr(0, length_of(words, kNameCharacters));
  if (std::ranges::find(kIdleDirectives, word) == kIdleDirectives.end()) return false;
  place_ += line.size();
  return true;
}

/// The separator here, and the line behind it.
IdlToken IdlLexer::section() {
  const std::size_t separator = line_at(place_).size();
  place_ += std::min(separator + 1, text_.size() - place_);
  ++line_;
  return take(IdlTokenKind::kSection, line_at(place_).size());
}

IdlToken IdlLexer::quoted(char quote) {
  std::size_t end = place_ + 1;
  while (end < text_.size() && text_[end] != quote && text_[end] != '\n') {
    end += text_[end] == '\\' ? 2 : 1;
  }
  if (end >= text_.size() || text_[end] != quote) {
    return take(IdlTokenKind::kUnreadable, line_at(place_).size());
  }
  return take(quote == '"' ? IdlTokenKind::kText : IdlTokenKind::kCharacter, end + 1 - place_);
}

IdlToken IdlLexer::next() {
  while (true) {
    if (!skip_blanks_and_comments()) return take(IdlTokenKind::kUnreadable, line_at(place_).size());
    if (place_ == text_.size()) return {IdlTokenKind::kEnd, {}, line_};
    if (text_[place_] != '#' || !at_line_start_) break;
    if (!skip_directive()) return take(IdlTokenKind::kUnreadable, line_at(place_).size());
  }
  const char c = text_[place_];
  if (at_line_start_ && is_separator(trimmed(line_at(place_), kBlank))) return section();
  if (c == '"' || c == '\'') return quoted(c);
  if (kDigits.find(c) != kDigits.npos) {
    return take(IdlTokenKind::kNumber, length_of_number(rest()));
  }
  const std::size_t name = length_of(rest(), kNameCharacters);
  if (name > 0) return take(IdlTokenKind::kName, name);
  return take(IdlTokenKind::kSign, rest().starts_with("::") ? 2 : 1);
}

}  // namespace aims
