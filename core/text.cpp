// SPDX-License-Identifier: BSD-3-Clause
#include "core/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>

namespace aims {

std::string shell_word(const std::string& word) {
  const auto is_plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("-_./=,:+@%").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::ranges::all_of(word, is_plain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

namespace {

/// Kept whole, so that a message still names the file.
constexpr std::size_t kLongestWord = 511;
constexpr std::size_t kShownOfWord = 80;
constexpr std::size_t kLongestMessage = 4000;

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 0;
};

/// Bytes of a UTF-8 sequence and the smallest code that needs them, by its first byte.
struct SequenceForm {
  unsigned char mask;
  unsigned char lead;
  std::size_t bytes;
  std::uint32_t least;
};
constexpr std::array<SequenceForm, 4> kForms = {
    {{0x80, 0x00, 1, 0}, {0xE0, 0xC0, 2, 0x80}, {0xF0, 0xE0, 3, 0x800}, {0xF8, 0xF0, 4, 0x10000}}};

/// The character at the front of `text`; nothing when it is not UTF-8 (RFC 3629).
std::optional<Character> first_character(std::string_view text) {
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  for (const SequenceForm& form : kForms) {
    if ((byte(0) & form.mask) != form.lead) continue;
    if (text.size() < form.bytes) return std::nullopt;
    std::uint32_t code = byte(0) & static_cast<unsigned char>(~form.mask);
    for (std::size_t i = 1; i < form.bytes; ++i) {
      if ((byte(i) & 0xC0U) != 0x80U) return std::nullopt;
      code = code << 6U | (byte(i) & 0x3FU);
    }
    const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
    if (code < form.least || code > 0x10FFFF || surrogate) return std::nullopt;
    return Character{code, form.bytes};
  }
  return std::nullopt;
}

/// C0, DEL and C1, of which ESC and CSI begin commands to a terminal.
bool is_control(std::uint32_t code) { return code < 0x20 || (code >= 0x7F && code <= 0x9F); }

/// The text with \xNN for the bytes that are no UTF-8 and for characters that `refused` names.
template <class Refused>
std::string escaped(std::string_view text, const Refused& refused) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const auto character = first_character(text);
    const std::size_t bytes = character ? character->bytes : 1;
    if (character && !refused(character->code)) {
      result += text.substr(0, bytes);
    } else {
      for (const char c : text.substr(0, bytes)) {
        result += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
      }
    }
    text.remove_prefix(bytes);
  }
  return result;
}

/// Where `text` may be cut at or before `size` bytes without splitting a character.
std::size_t cut_before(std::string_view text, std::size_t size) {
  const auto continues = [&text](std::size_t i) {
    return (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
  };
  while (size > 0 && size < text.size() && continues(size)) --size;
  return size;
}

/// Long words as their first bytes and their length.
std::string with_short_words(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    if (word.size() <= kLongestWord) {
      result += word;
    } else {
      result += word.substr(0, cut_before(word, kShownOfWord));
      result += fmt::format("... ({} bytes)", word.size());
    }
    text.remove_prefix(end);
    if (text.empty()) break;
    result += ' ';
    text.remove_prefix(1);
  }
  return result;
}

}  // namespace

std::string utf8_text(std::string_view bytes) {
  return escaped(bytes, [](std::uint32_t) { return false; });
}

std::string terminal_text(std::string_view bytes) {
  return escaped(
      bytes, [](std::uint32_t code) { return is_control(code) && code != '\n' && code != '\t'; });
}

std::string name_text(std::string_view bytes) { return escaped(bytes, is_control); }

std::string line_text(std::string_view message) {
  const std::string text = with_short_words(name_text(message));
  if (text.size() <= kLongestMessage) return text;
  const std::size_t head = cut_before(text, kLongestMessage / 2);
  const std::size_t tail = cut_before(text, text.size() - kLongestMessage / 4);
  return fmt::format("{} ... ({} bytes) ... {}", text.substr(0, head), tail - head,
                     text.substr(tail));
}

std::string_view trimmed(std::string_view text, std::string_view blanks) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string_view take_until(std::string_view& text, char separator) {
  const std::size_t end = std::min(text.find(separator), text.size());
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return part;
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (!text.empty()) parts.emplace_back(take_until(text, separator));
  return parts;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::string decimal_text(double value, int digits) {
  std::string text = fmt::format("{:.{}f}", value, digits);
  const bool zero = text.find_first_not_of("-0.") == std::string::npos;
  return zero && text.front() == '-' ? text.substr(1) : text;
}

std::string counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string stamp_text(Time stamp) {
  const bool negative = stamp < 0;
  // Negated as unsigned, so that the smallest integer has a magnitude too.
  const auto magnitude = negative ? std::uint64_t{0} - static_cast<std::uint64_t>(stamp)
                                  : static_cast<std::uint64_t>(stamp);
  const auto second = static_cast<std::uint64_t>(kSecond);
  return fmt::format("{}{}.{:09}", negative ? "-" : "", magnitude / second, magnitude % second);
}

}  // namespace aims
