// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/csv_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "core/files/number_lines.hpp"
#include "core/files/text_file.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

/// Reads rows of comma-separated values (RFC 4180).
class RowReader {
 public:
  RowReader(std::string_view text, char separator) : text_(text), separator_(separator) {}

  void begin_at(std::size_t position) {
    line_ += static_cast<int>(std::ranges::count(text_.substr(0, position), '\n'));
    position_ = position;
  }
  bool at_end() const { return position_ >= text_.size(); }
  int line() const { return line_; }

  /// Appends the next row's cells to `cells`, and their ends to `ends`; false when the text ends
  /// before the row does.
  bool take(std::string& cells, std::vector<std::size_t>& ends) {
    while (true) {
      const bool complete = take_cell(cells);
      ends.push_back(cells.size());
      if (!complete) return false;
      const char end = text_[position_++];
      if (end == separator_) continue;
      ++line_;
      return true;
    }
  }

  /// Passes over blank lines and comments.
  void skip_comments() {
    while (!at_end()) {
      const std::size_t first = text_.find_first_not_of(" \t\r", position_);
      if (first != std::string_view::npos && text_[first] != '#' && text_[first] != '\n') return;
      position_ = std::min(text_.find('\n', position_), text_.size() - 1) + 1;
      ++line_;
    }
  }

 private:
  /// Appends up to the comma or line end after the cell; false at the end of the text.
  bool take_cell(std::string& cell) {
    bool quoted = false;
    std::size_t kept = cell.size();  // bytes up to the cell's last closing quote
    for (; position_ < text_.size(); ++position_) {
      const char c = text_[position_];
      if (c == '"') {
        const bool doubled = quoted && text_.substr(position_ + 1, 1) == "\"";
        if (doubled) cell += text_[position_++];
        if (!doubled) quoted = !quoted;
        if (!quoted) kept = cell.size();
      } else if (!quoted && (c == separator_ || c == '\n')) {
        if (c == '\n' && cell.size() > kept && cell.ends_with('\r')) cell.pop_back();
        return true;
      } else {
        if (c == '\n') ++line_;
        cell += c;
      }
    }
    return false;
  }

  std::string_view text_;
  char separator_;
  std::size_t position_ = 0;
  int line_ = 1;
};

constexpr std::string_view kBlanks = " \t\r";

/// The character that separates the cells of a header of another tool.
char separator_of(std::string_view header) {
  for (const char each : {',', ';', '\t'}) {
    if (header.find(each) != std::string_view::npos) return each;
  }
  return ',';
}

/// Where the header of another tool's table begins: at its first line that is no comment, or a
/// comment with as many cells as the line behind it.
std::size_t header_begin(std::string_view text) {
  std::size_t begin = 0;
  const auto cells = [&](std::size_t from) {
    const std::string_view line = text.substr(from, text.find('\n', from) - from);
    return std::ranges::count(line, separator_of(line));
  };
  while (begin < text.size()) {
    const std::size_t end = text.find('\n', begin);
    const std::size_t first = text.find_first_not_of(" \t\r", begin);
    if (end == std::string_view::npos || first == std::string_view::npos) return begin;
    const bool blank = first == end;
    const bool named = text[first] == '#' && end + 1 < text.size() && text[end + 1] != '#' &&
                       cells(begin) > 0 && cells(begin) == cells(end + 1);
    if (!blank && (text[first] != '#' || named)) return begin;
    begin = end + 1;
  }
  return 0;
}

/// A decimal comma in the cell from `from` on becomes a point, where commas separate no cells.
void decimal_point(std::string& cells, std::size_t from) {
  const std::size_t comma = cells.find(',', from);
  const bool number = cells.find_first_not_of("+-0123456789,eE \t\r", from) == std::string::npos;
  if (comma != std::string::npos && number && cells.find(',', comma + 1) == std::string::npos) {
    cells[comma] = '.';
  }
}

std::optional<double> number_of(std::string_view cell) {
  if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
  if (cell == "true") return 1.0;
  if (cell == "false") return 0.0;
  return parse_number(cell, false);
}

}  // namespace

Result<CsvColumns> CsvColumns::parse(std::string_view text, const std::string& name,
                                     std::span<const std::string> only, CsvOrigin origin) {
  const bool foreign = origin != CsvOrigin::kOwn;
  CsvColumns table;
  table.name_ = name;
  table.foreign_ = foreign;
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  const std::size_t begin = foreign ? header_begin(text) : 0;
  const std::string_view first_line = text.substr(begin, text.find('\n', begin) - begin);
  const char separator = foreign ? separator_of(first_line) : ',';
  RowReader reader(text, separator);
  reader.begin_at(begin);
  CsvColumns row;  // all cells of one
  if (!reader.take(row.cells_, row.ends_)) {
    return failure(fmt::format("{}:1: expected a header that ends in a line end", name));
  }
  const std::size_t columns = row.ends_.size();
  row.header_.resize(columns);
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < columns; ++i) {
    std::string title(row.cell(0, i));
    if (foreign) title = trimmed(title, kBlanks);
    if (foreign && title.starts_with('#')) {
      table.index_.emplace(title, table.header_.size());  // by either name
      title = trimmed(std::string_view(title).substr(1), kBlanks);
    }
    if (!only.empty() && std::ranges::find(only, title) == only.end()) continue;
    table.index_.emplace(title, table.header_.size());
    table.header_.push_back(title);
    kept.push_back(i);
  }
  while (true) {
    if (foreign) reader.skip_comments();
    if (reader.at_end()) break;
    const int line = reader.line();
    row.cells_.clear();
    row.ends_.clear();
    bool complete = reader.take(row.cells_, row.ends_);
    const std::size_t found = row.ends_.size();
    if (!complete && found == columns && foreign && !row.cell(0, columns - 1).empty())
      complete = true;
    if (!complete && origin == CsvOrigin::kDamaged) break;
    if (!complete || found != columns) {
      return failure(fmt::format("{}:{}: expected {} cells and a line end, found {} cells{}", name,
                                 line, columns, found, complete ? "" : ", truncated"));
    }
    for (const std::size_t i : kept) {
      const std::size_t from = table.cells_.size();
      table.cells_ += row.cell(0, i);
      if (separator != ',') decimal_point(table.cells_, from);
      table.ends_.push_back(table.cells_.size());
    }
    table.lines_.push_back(line);
  }
  table.rows_ = table.lines_.size();
  return table;
}

Result<CsvColumns> CsvColumns::read(const std::filesystem::path& file,
                                    std::span<const std::string> only) {
  const auto text = read_text_file(file);
  if (!text) return tl::unexpected(text.error());
  return parse(*text, file.string(), only);
}

Result<std::vector<double>> CsvColumns::numbers(std::string_view column) const {
  std::vector<double> numbers;
  const auto found = index_.find(column);
  if (found == index_.end()) return numbers;
  numbers.reserve(rows_);
  for (std::size_t row = 0; row < rows_; ++row) {
    const std::string_view text =
        foreign_ ? trimmed(cell(row, found->second), kBlanks) : cell(row, found->second);
    const auto number = number_of(text);
    if (!number) {
      return failure(line_text(fmt::format("{}:{}: {}: expected a number, found '{}'", name_,
                                           lines_[row], column, text)));
    }
    numbers.push_back(*number);
  }
  return numbers;
}

std::vector<std::string> CsvColumns::texts(std::string_view column) const {
  std::vector<std::string> texts;
  const auto found = index_.find(column);
  if (found == index_.end()) return texts;
  for (std::size_t row = 0; row < rows_; ++row) {
    const std::string_view text = cell(row, found->second);
    texts.emplace_back(foreign_ ? trimmed(text, kBlanks) : text);
  }
  return texts;
}

}  // namespace aims
