// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/csv.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cmath>

#include "core/files/atomic_file.hpp"

namespace aims {
namespace {

std::string escaped(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace

CsvTable::CsvTable(const std::vector<std::string>& header) : columns_(header.size()) {
  for (const std::string& name : header) add(name);
  end_row();
}

void CsvTable::add_cell(std::string_view cell) {
  assert(cells_in_row_ < columns_);
  if (cells_in_row_ > 0) text_ += ',';
  text_ += cell;
  ++cells_in_row_;
}

CsvTable& CsvTable::add(std::string_view text) {
  add_cell(escaped(text));
  return *this;
}

CsvTable& CsvTable::add(double value) {
  add_cell(std::isfinite(value) ? fmt::format("{}", value) : std::string());
  return *this;
}

CsvTable& CsvTable::add(const std::optional<double>& value) {
  return value ? add(*value) : add_empty();
}

CsvTable& CsvTable::add_integer(std::int64_t value) {
  add_cell(fmt::format("{}", value));
  return *this;
}

CsvTable& CsvTable::add(bool value) {
  add_cell(value ? "true" : "false");
  return *this;
}

CsvTable& CsvTable::add_empty() {
  add_cell({});
  return *this;
}

void CsvTable::end_row() {
  while (cells_in_row_ < columns_) add_cell({});
  text_ += '\n';
  cells_in_row_ = 0;
}

Result<void> write_csv(const std::filesystem::path& file, const CsvTable& table) {
  return write_file_atomically(file, table.text());
}

}  // namespace aims
