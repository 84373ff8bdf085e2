// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// Builds a table as comma-separated values (RFC 4180 quoting, lines end in LF). Doubles are
/// written with the shortest decimals that read back equal; missing and non-finite values are empty
/// cells.
class CsvTable {
 public:
  explicit CsvTable(const std::vector<std::string>& header);

  CsvTable& add(std::string_view text);
  CsvTable& add(const char* text) { return add(std::string_view(text)); }
  CsvTable& add(const std::string& text) { return add(std::string_view(text)); }
  CsvTable& add(double value);
  CsvTable& add(const std::optional<double>& value);
  CsvTable& add(std::integral auto value) { return add_integer(static_cast<std::int64_t>(value)); }
  CsvTable& add(bool value);
  CsvTable& add_empty();

  /// Ends the row; missing cells are empty.
  void end_row();

  /// The table so far, header included.
  const std::string& text() const { return text_; }

  /// Removes and returns the text of whole rows so far, for a table that is written in parts.
  std::string take_text() { return std::exchange(text_, {}); }

 private:
  CsvTable& add_integer(std::int64_t value);
  void add_cell(std::string_view cell);

  std::size_t columns_;
  std::size_t cells_in_row_ = 0;
  std::string text_;
};

/// Writes the table atomically.
Result<void> write_csv(const std::filesystem::path& file, const CsvTable& table);

}  // namespace aims
