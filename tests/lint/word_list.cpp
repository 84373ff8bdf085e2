// SPDX-License-Identifier: BSD-3-Clause
#include "tests/lint/word_list.hpp"

#include <stdexcept>

namespace aims::lint {
namespace {

std::regex compile(const std::string& pattern, const Line& line) {
  try {
    return std::regex(pattern, std::regex::ECMAScript | std::regex::icase | std::regex::optimize);
  } catch (const std::regex_error& error) {
    throw std::runtime_error(place(line) + ": " + error.what() + ": " + pattern);
  }
}

/// `text` with blanks in place of the phrases in which a word is right.
std::string without_allowed(const std::string& text, const PrivateWord& word) {
  std::string rest = text;
  for (const std::regex& phrase : word.allowed) {
    std::smatch match;
    while (std::regex_search(rest, match, phrase)) {
      rest.replace(static_cast<std::size_t>(match.position()),
                   static_cast<std::size_t>(match.length()),
                   std::string(static_cast<std::size_t>(match.length()), ' '));
    }
  }
  return rest;
}

}  // namespace

std::vector<PrivateWord> read_word_list(const std::filesystem::path& file) {
  const std::string allow = "  allow ";
  const std::string arrow = " => ";
  std::vector<PrivateWord> words;
  for (const Line& line : read_lines(file)) {
    if (line.text.empty() || line.text.starts_with("#")) continue;
    if (line.text.starts_with(allow) && !words.empty()) {
      words.back().allowed.push_back(compile(line.text.substr(allow.size()), line));
      continue;
    }
    const std::size_t split = line.text.find(arrow);
    if (split == std::string::npos) {
      throw std::runtime_error(place(line) + ": expected REGEX => REPLACEMENT");
    }
    words.push_back(
        {compile(line.text.substr(0, split), line), line.text.substr(split + arrow.size()), {}});
  }
  return words;
}

std::vector<std::string> private_words_in(const std::vector<Line>& lines,
                                          const std::vector<PrivateWord>& words) {
  std::vector<std::string> found;
  for (const Line& line : lines) {
    for (const PrivateWord& word : words) {
      std::smatch match;
      const std::string text = without_allowed(line.text, word);
      if (!std::regex_search(text, match, word.pattern)) continue;
      found.push_back(place(line) + ": \"" + match.str() + "\": write " + word.replacement);
    }
  }
  return found;
}

}  // namespace aims::lint
