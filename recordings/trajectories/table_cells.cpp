// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/trajectories/table_cells.hpp"

#include <algorithm>
#include <string>

#include "core/files/number_lines.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

constexpr std::size_t kFewestColumns = 4;  ///< stamp and position

std::string_view bare(std::string_view cell) {
  const std::size_t begin = std::min(cell.find_first_not_of(" \t\r\"#%"), cell.size());
  return trimmed(cell.substr(begin), " \t\r\"");
}

}  // namespace

std::string_view take_line(std::string_view& text) {
  const std::size_t feed = std::min(text.find('\n'), text.size());
  std::size_t end = std::min(text.find('\r'), feed);
  if (end + 1 == feed) end = feed;
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

std::string_view without_comment(std::string_view line) {
  const std::size_t first = std::min(line.find_first_not_of(" \t"), line.size());
  return line.substr(0, line.find('#', std::min(first + 1, line.size())));
}

bool is_comment(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return true;
  // The separator that a spreadsheet is told.
  if (line.substr(first).starts_with("sep=")) return true;
  return line[first] == '#' || line[first] == '%' || line.substr(first).starts_with("//");
}

bool is_number_with_comma(std::string_view word) {
  std::string text(word);
  if (const std::size_t comma = text.find(','); comma != std::string::npos) text[comma] = '.';
  return parse_number(text, false).has_value();
}

char separator_of(std::string_view line) {
  if (line.find(';') != std::string_view::npos) return ';';
  const bool commas = line.find(',') != std::string_view::npos;
  if (std::ranges::count(line, '\t') >= 3 && line.find(",\t") == std::string_view::npos)
    return '\t';
  if (!commas) return ' ';
  const auto words = words_of(line);
  const bool decimal = words.size() >= kFewestColumns &&
                       std::ranges::all_of(words, is_number_with_comma) &&
                       std::ranges::none_of(words, [](auto word) { return word.ends_with(','); });
  return decimal ? ' ' : ',';
}

std::vector<std::string_view> cells_of(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  if (separator == ' ') {
    for (const std::string_view word : words_of(line)) {
      if (const auto cell = bare(word); !cell.empty()) cells.push_back(cell);
    }
    return cells;
  }
  while (true) {
    const std::size_t end = std::min(line.find(separator), line.size());
    cells.push_back(bare(line.substr(0, end)));
    if (end == line.size()) return cells;
    line.remove_prefix(end + 1);
  }
}

}  // namespace aims
