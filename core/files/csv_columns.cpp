// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/csv_columns.hpp"

#include <fmt/format.h>

#include <limits>
#include <optional>
#include <utility>

#include "core/files/atomic_file.hpp"
#include "core/files/number_lines.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

/// Reads rows of comma-separated values (RFC 4180).
class RowReader {
 public:
  explicit RowReader(std::string_view text) : text_(text) {}

  bool at_end() const { return position_ >= text_.size(); }
  int line() const { return line_; }

  /// Appends the next row's cells; false when the text ends before the row does.
  bool take(std::vector<std::string>& cells) {
    while (true) {
      cells.emplace_back();
      if (!take_cell(cells.back())) return false;
      const char end = text_[position_++];
      if (end == ',') continue;
      ++line_;
      return true;
    }
  }

 private:
  /// Reads up to the comma or line end after the cell; false at the end of the text.
  bool take_cell(std::string& cell) {
    bool quoted = false;
    std::size_t kept = 0;  // bytes of the cell up to its last closing quote
    for (; position_ < text_.size(); ++position_) {
      const char c = text_[position_];
      if (c == '"') {
        const bool doubled = quoted && text_.substr(position_ + 1, 1) == "\"";
        if (doubled) cell += text_[position_++];
        if (!doubled) quoted = !quoted;
        if (!quoted) kept = cell.size();
      } else if (!quoted && (c == ',' || c == '\n')) {
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
  std::size_t position_ = 0;
  int line_ = 1;
};

std::optional<double> number_of(const std::string& cell) {
  if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
  if (cell == "true") return 1.0;
  if (cell == "false") return 0.0;
  return parse_number(cell, false);
}

}  // namespace

Result<CsvColumns> CsvColumns::parse(std::string_view text, const std::string& name) {
  CsvColumns table;
  table.name_ = name;
  RowReader reader(text);
  if (!reader.take(table.header_)) {
    return failure(fmt::format("{}:1: expected a header that ends in a line end", name));
  }
  for (std::size_t i = 0; i < table.header_.size(); ++i) table.index_.emplace(table.header_[i], i);
  while (!reader.at_end()) {
    const int line = reader.line();
    const std::size_t before = table.cells_.size();
    const bool complete = reader.take(table.cells_);
    const std::size_t found = table.cells_.size() - before;
    if (!complete || found != table.header_.size()) {
      return failure(fmt::format("{}:{}: expected {} cells and a line end, found {} cells{}", name,
                                 line, table.header_.size(), found, complete ? "" : ", truncated"));
    }
    table.lines_.push_back(line);
  }
  table.rows_ = table.lines_.size();
  return table;
}

Result<CsvColumns> CsvColumns::read(const std::filesystem::path& file) {
  const auto text = read_file(file);
  if (!text) return tl::unexpected(text.error());
  return parse(*text, file.string());
}

Result<std::vector<double>> CsvColumns::numbers(std::string_view column) const {
  std::vector<double> numbers;
  const auto found = index_.find(column);
  if (found == index_.end()) return numbers;
  numbers.reserve(rows_);
  for (std::size_t row = 0; row < rows_; ++row) {
    const std::string& text = cell(row, found->second);
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
  for (std::size_t row = 0; row < rows_; ++row) texts.push_back(cell(row, found->second));
  return texts;
}

}  // namespace aims
