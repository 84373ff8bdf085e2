// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/words.hpp"

#include <cctype>

namespace aims {

bool has_word(std::string_view text, std::string_view word, std::string_view also) {
  const auto is_in_word = [also](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           also.find(c) != std::string_view::npos;
  };
  for (std::size_t at = text.find(word); at != std::string_view::npos;
       at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !is_in_word(text[at - 1])) && (end == text.size() || !is_in_word(text[end]))) {
      return true;
    }
  }
  return false;
}

}  // namespace aims
