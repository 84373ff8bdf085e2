// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/time.hpp"

namespace aims {

/// The word as a POSIX shell reads it back; a plain one as it is.
std::string shell_word(const std::string& word);

/// The bytes as valid UTF-8: what is not UTF-8 becomes \xNN, so that a name stays recognizable.
std::string utf8_text(std::string_view bytes);

/// `utf8_text` that a terminal shows and never obeys: control characters except line end and tab
/// become \xNN too.
std::string terminal_text(std::string_view bytes);

/// `terminal_text` on one line: line ends and tabs become \xNN too.
std::string name_text(std::string_view bytes);

/// A message that names values of any length and content, as one line that a terminal can show:
/// control characters become \xNN, words of more than 511 bytes their first 80 and the length,
/// and of a message of more than 4000 bytes the middle is left out.
std::string line_text(std::string_view message);

/// Without the characters of `blanks` at either end.
std::string_view trimmed(std::string_view text, std::string_view blanks = " \t");

/// Takes the text up to the separator, or to the end, off the front, and that separator with it.
std::string_view take_until(std::string_view& text, char separator);

/// The parts before, between and behind the separators; a last one that is empty is none.
std::vector<std::string> split(std::string_view text, char separator);

/// The number that fills the whole text, without sign or with a minus; nothing when it is none, or
/// does not fit.
template <class Number>
std::optional<Number> number_from(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// With a to z for A to Z; other characters stay.
std::string lower_case(std::string_view text);

/// The number with so many decimals; what rounds to zero has no sign.
std::string decimal_text(double value, int digits);

/// "1 point", "4 points".
std::string counted(std::size_t count, std::string_view noun);

/// Seconds with nine decimals, which keep the nanoseconds exactly.
std::string stamp_text(Time stamp);

}  // namespace aims
