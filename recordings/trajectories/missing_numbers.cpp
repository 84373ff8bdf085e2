// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/trajectories/missing_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/files/number_lines.hpp"

namespace aims {
namespace {

constexpr std::array<std::string_view, 8> kNames = {"stamp", "x", "y", "z", "qx", "qy", "qz", "qw"};

bool is_missing(std::string_view word) {
  const auto number = parse_number(word, false);
  return number && !std::isfinite(*number);
}

std::string_view word_for(std::string_view word) {
  return std::isnan(*parse_number(word, false)) ? "NaN (or an empty cell)" : "infinite";
}

/// The column of a number, by its name where the lines have stamps.
std::string column_text(std::size_t column, std::size_t columns) {
  return columns > kNames.size() ? fmt::format("column {}", column + 1)
                                 : std::string(kNames[column]);
}

/// Whether the words are of a line with a stamp in front.
bool has_stamp(std::size_t words) { return words <= kNames.size(); }

}  // namespace

std::string with_stamps(std::string_view text, const std::string& name,
                        std::vector<std::string>& notes) {
  std::string kept;
  kept.reserve(text.size());
  int line_number = 0, left_out = 0, first = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++line_number;
    const auto words = words_of(line);
    if (!words.empty() && has_stamp(words.size()) && is_missing(words[0])) {
      first = left_out++ == 0 ? line_number : first;
    } else {
      kept += line;
    }
    kept += '\n';
  }
  if (left_out > 0) {
    notes.push_back(
        fmt::format("{}:{}: the stamp is NaN (or an empty cell): {} such line{} left out", name,
                    first, left_out, left_out == 1 ? " is" : "s are"));
  }
  return kept;
}

void note_missing_numbers(std::string_view text, const std::string& name,
                          std::vector<std::string>& notes) {
  LineReader lines(text, name);
  int found = 0;
  std::string first;
  while (const auto line = lines.next()) {
    const auto words = words_of(*line);
    const auto missing = std::ranges::find_if(words, is_missing);
    if (missing == words.end() || found++ > 0) continue;
    const auto column = static_cast<std::size_t>(missing - words.begin());
    first = fmt::format("{}:{}: {} is {}", name, lines.number(), column_text(column, words.size()),
                        word_for(*missing));
  }
  if (found == 0) return;
  notes.push_back(fmt::format("{}: {} line{} such a number, and {} no pose", first, found,
                              found == 1 ? " holds" : "s hold", found == 1 ? "is" : "are"));
}

}  // namespace aims
