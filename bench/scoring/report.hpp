// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/metrics/statistics.hpp"
#include "bench/scoring/score_list.hpp"
#include "core/error.hpp"
#include "core/files/csv.hpp"
#include "core/files/table.hpp"

namespace aims {

/// The text of a number in a table, by a format of fmt ("{:.3f}"); `none` when there is none.
std::string number_text(const std::optional<double>& value, const std::string& format,
                        const char* none = "-");

/// "[low, high]", both by `format`; `none` when the data do not determine it.
std::string interval_text(const Interval& interval, const std::string& format,
                          const char* none = "-");

/// [low, high], null for an end that the data do not determine.
Json interval_json(const Interval& interval);

/// A value of JSON as a cell.
std::string cell_text(const Json& value, const std::string& format, const char* none);
void add_cell(const Json& value, CsvTable& table);

inline Json json_cell(Json value) { return value; }

template <class Value>
Json json_cell(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}

/// A column of a study's results, which are rows of type `Row`: the only place that knows its key,
/// how it is shown and its value.
template <class Row>
struct TableColumn {
  /// `value` is a member of the row or a function of it.
  template <class Value>
  TableColumn(std::string its_key, std::string its_title, Value its_value,
              std::string its_format = "{}")
      : key(std::move(its_key)),
        title(std::move(its_title)),
        value([its_value](const Row& row) { return json_cell(std::invoke(its_value, row)); }),
        format(std::move(its_format)) {}

  std::string key;    ///< of JSON and CSV; empty: in neither
  std::string title;  ///< of tables for readers; empty: in none
  std::function<Json(const Row& row)> value;
  std::string format;  ///< of a number in such a table
};

template <class Row>
using TableColumns = std::vector<TableColumn<Row>>;

/// The row as a JSON object.
template <class Row>
Json row_json(const TableColumns<Row>& columns, const Row& row) {
  Json json = Json::object();
  for (const auto& column : columns) {
    if (!column.key.empty()) json[column.key] = column.value(row);
  }
  return json;
}

/// All rows as a JSON array.
template <class Row, class Rows>
Json rows_json(const TableColumns<Row>& columns, const Rows& rows) {
  return json_array(rows, [&columns](const Row& row) { return row_json(columns, row); });
}

/// The rows column by column, as a JSON object of arrays; null without rows.
template <class Row, class Rows>
Json columns_json(const TableColumns<Row>& columns, const Rows& rows) {
  Json json;
  for (const Row& row : rows) {
    for (const auto& column : columns) {
      if (!column.key.empty()) json[column.key].push_back(column.value(row));
    }
  }
  return json;
}

/// The keys, behind those of what stands before the columns.
template <class Row>
std::vector<std::string> csv_header(const TableColumns<Row>& columns,
                                    std::vector<std::string> before = {}) {
  for (const auto& column : columns) {
    if (!column.key.empty()) before.push_back(column.key);
  }
  return before;
}

/// Adds the row's cells to the row of `table` that is under way.
template <class Row>
void add_cells(const TableColumns<Row>& columns, const Row& row, CsvTable& table) {
  for (const auto& column : columns) {
    if (!column.key.empty()) add_cell(column.value(row), table);
  }
}

template <class Row, class Rows>
CsvTable rows_csv(const TableColumns<Row>& columns, const Rows& rows) {
  CsvTable table(csv_header(columns));
  for (const Row& row : rows) {
    add_cells(columns, row, table);
    table.end_row();
  }
  return table;
}

/// A table for readers; `none` stands for what has no value.
template <class Row, class Rows>
TextTable rows_table(const TableColumns<Row>& columns, const Rows& rows, const char* none = "-") {
  TextTable table;
  for (const auto& column : columns) {
    if (!column.title.empty()) table.header.push_back(column.title);
  }
  for (const Row& row : rows) {
    std::vector<std::string>& cells = table.rows.emplace_back();
    for (const auto& column : columns) {
      if (column.title.empty()) continue;
      cells.push_back(cell_text(column.value(row), column.format, none));
    }
  }
  return table;
}

/// Of a report on jobs that have not all ended.
inline constexpr const char* kInterruptedNote = "**Interrupted: of the finished runs alone.**\n";

/// What a study, a suite or a scoring came to, in the forms in which results are read; an absent
/// one is not written.
struct Report {
  std::string name;  ///< of the files, without ending
  std::optional<std::string> markdown = {};
  std::optional<CsvTable> csv = {};
  std::optional<Json> json = {};
  int indent = 2;  ///< of the JSON
  std::optional<std::string> latex = {};
};

/// Writes NAME.md, NAME.csv, NAME.json and NAME.tex into `folder`, which is made when it is
/// missing.
Result<void> write_report(const Report& report, const std::filesystem::path& folder);

}  // namespace aims
