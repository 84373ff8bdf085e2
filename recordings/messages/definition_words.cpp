// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/definition_words.hpp"

#include <algorithm>

#include "core/text.hpp"

namespace aims {
namespace {

constexpr std::size_t kMaxNameBytes = 128;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_name_character(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; }

}  // namespace

bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= kMaxNameBytes && is_letter(text[0]) &&
         std::all_of(text.begin(), text.end(), is_name_character);
}

bool is_separator(std::string_view line) {
  return line.size() >= 3 && line.find_first_not_of('=') == std::string_view::npos;
}

std::optional<std::uint32_t> count_in(std::string_view digits) {
  const auto count = number_from<std::uint32_t>(digits);
  return count && *count > 0 ? count : std::nullopt;
}

}  // namespace aims
