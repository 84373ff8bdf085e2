// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "tests/lint/documents.hpp"

namespace aims::lint {

/// A word that is not to be used.
struct PrivateWord {
  std::regex pattern;
  std::string replacement;
  std::vector<std::regex> allowed;  ///< phrases in which it is right
};

/// The entries of `file`, a path below the source folder. Throws std::runtime_error with file and
/// line of an entry that is none.
std::vector<PrivateWord> read_word_list(const std::filesystem::path& file);

/// One message for each private word in `lines`: file, line, word and replacement.
std::vector<std::string> private_words_in(const std::vector<Line>& lines,
                                          const std::vector<PrivateWord>& words);

}  // namespace aims::lint
