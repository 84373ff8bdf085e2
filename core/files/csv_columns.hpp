// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// Whose table it is.
enum class CsvOrigin {
  kOwn,      ///< written by CsvTable
  kForeign,  ///< of any tool: blanks around cells, comments (#), blank lines, semicolons or tabs
             ///< (then also decimal commas), no line end behind the last row
  kDamaged,  ///< likewise, and its last row may be incomplete: it is left out
};

/// A table of comma-separated values, as written by CsvTable, by column name.
class CsvColumns {
 public:
  /// Every row must have as many cells as the header and end in a line end, so that a truncated
  /// file is detected. Columns that are not in `only` are left out, unless that is empty. Errors:
  /// "name:line: ...".
  static Result<CsvColumns> parse(std::string_view text, const std::string& name,
                                  std::span<const std::string> only = {},
                                  CsvOrigin origin = CsvOrigin::kOwn);
  /// Reads a file with `parse`.
  static Result<CsvColumns> read(const std::filesystem::path& file,
                                 std::span<const std::string> only = {});

  std::size_t rows() const { return rows_; }
  /// The line at which a row begins, from 1.
  int line(std::size_t row) const { return lines_[row]; }
  const std::vector<std::string>& header() const { return header_; }
  bool has(std::string_view column) const { return index_.contains(column); }

  /// The numbers of a column, NaN for an empty cell, 1 and 0 for true and false; no numbers when
  /// the table has no such column. Error for a cell that is neither.
  Result<std::vector<double>> numbers(std::string_view column) const;

  /// The cells of a column; none when the table has no such column.
  std::vector<std::string> texts(std::string_view column) const;

 private:
  std::string_view cell(std::size_t row, std::size_t column) const {
    const std::size_t index = row * header_.size() + column;
    const std::size_t begin = index == 0 ? 0 : ends_[index - 1];
    return std::string_view(cells_).substr(begin, ends_[index] - begin);
  }

  std::string name_;
  bool foreign_ = false;
  std::vector<std::string> header_;
  std::map<std::string, std::size_t, std::less<>> index_;  ///< column of each name
  std::string cells_;                                      ///< row by row, end to end
  std::vector<std::size_t> ends_;                          ///< of the cells in `cells_`
  std::vector<int> lines_;                                 ///< at which each row begins
  std::size_t rows_ = 0;
};

}  // namespace aims
