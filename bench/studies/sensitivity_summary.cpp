// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "bench/metrics/statistics.hpp"
#include "bench/scoring/report.hpp"
#include "bench/scoring/score_record.hpp"
#include "bench/studies/sensitivity.hpp"

namespace aims {
namespace {

constexpr const char* kSensitivityIntroduction =
    "# Sensitivity of `{0}` to its settings\n"
    "\n"
    "One setting at a time, its number times a factor, on the same {1} sequences; all else as\n"
    "before. Ratios are of the median ATE yaw ({2}), above 1 where the change makes it worse;\n"
    "\"3 of 5\": over the sequences alone of which the variant lacks no part. In brackets the\n"
    "sequences on which `{0}` alone succeeds (-) and the variant alone (+). A dash stands where\n"
    "there is nothing to compare: the setting does not allow the value, or the variant failed or\n"
    "lacks a part of every run. p: sign test of the successes over seeds. Settings that cost\n"
    "successes come first, then the largest changes.\n";

const TableColumns<SensitivityCell>& cell_columns() {
  using Cell = SensitivityCell;
  static const TableColumns<Cell> columns = {
      {"factor", "", &Cell::factor}, {"ate_ratio", "", &Cell::ratio},
      {"pairs", "", &Cell::pairs},   {"lost", "", &Cell::lost},
      {"won", "", &Cell::won},       {"success_p", "", &Cell::success_p}};
  return columns;
}

/// "1.250, 3 of 5 (-2) p 0.5": of the sequences that have an ATE of both.
std::string sensitivity_cell_text(const SensitivityCell& cell, std::size_t sequences) {
  std::string text = number_text(cell.ratio, "{:.3f}");
  if (cell.ratio && cell.pairs < sequences)
    text += fmt::format(", {} of {}", cell.pairs, sequences);
  if (cell.lost > 0) text += fmt::format(" (-{})", cell.lost);
  if (cell.won > 0) text += fmt::format(" (+{})", cell.won);
  if (cell.lost + cell.won > 0) text += fmt::format(" p {:.2g}", cell.success_p);
  return text;
}

std::string sensitivity_markdown(const SettingSensitivity& sensitivity, const Suite& suite) {
  const std::string ate = number_text(sensitivity.median_ate, "{:.3f} m", "none");
  std::string text =
      fmt::format(kSensitivityIntroduction, sensitivity.estimator, sensitivity.sequences, ate);
  if (!suite.complete) text += fmt::format("\n{}", kInterruptedNote);
  text += "\n" + to_markdown(sensitivity_table(sensitivity));
  for (const std::string& line : left_out_lines(suite)) text += fmt::format("\n- {}", line);
  return text + markdown_list(suite.failures);
}

CsvTable sensitivity_csv(const SettingSensitivity& sensitivity) {
  CsvTable table(csv_header(cell_columns(), {"setting", "value"}));
  for (const SensitivityRow& row : sensitivity.rows) {
    for (const SensitivityCell& cell : row.cells) {
      table.add(row.key).add(row.value);
      add_cells(cell_columns(), cell, table);
      table.end_row();
    }
  }
  return table;
}

Json sensitivity_json(const SettingSensitivity& sensitivity, const Suite& suite) {
  Json json = study_head(kSensitivitySchema, suite);
  json["estimator"] = sensitivity.estimator;
  json["sequences"] = sensitivity.sequences;
  json["median_ate_yaw_m"] = json_of(sensitivity.median_ate);
  json["settings"] = Json::object();
  for (const SensitivityRow& row : sensitivity.rows) {
    json["settings"][row.key] = {{"value", row.value},
                                 {"changes", rows_json(cell_columns(), row.cells)}};
  }
  json["invalid"] = invalid_json(suite);
  return json;
}

}  // namespace

TextTable sensitivity_table(const SettingSensitivity& sensitivity) {
  TextTable table;
  table.header = {"setting", "value"};
  if (sensitivity.rows.empty()) return table;
  for (const SensitivityCell& cell : sensitivity.rows.front().cells) {
    table.header.push_back(fmt::format("x {:g}", cell.factor));
  }
  for (const SensitivityRow& row : sensitivity.rows) {
    std::vector<std::string> cells = {row.key, row.value};
    for (const SensitivityCell& cell : row.cells) {
      cells.push_back(sensitivity_cell_text(cell, sensitivity.sequences));
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Result<void> write_sensitivity(const SettingSensitivity& sensitivity, const Suite& suite,
                               const std::filesystem::path& folder) {
  return write_report({.name = "sensitivity",
                       .markdown = sensitivity_markdown(sensitivity, suite),
                       .csv = sensitivity_csv(sensitivity),
                       .json = sensitivity_json(sensitivity, suite)},
                      folder);
}

}  // namespace aims
