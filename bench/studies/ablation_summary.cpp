// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "bench/scoring/report.hpp"
#include "bench/scoring/score_record.hpp"
#include "bench/studies/ablation.hpp"
#include "bench/studies/success_columns.hpp"

namespace aims {
namespace {

constexpr const char* kAblationIntroduction =
    "# Ablation of `{0}`\n"
    "\n"
    "`no_PART` is `{0}` with that part turned off, on the same measurements (`with_PART`: turned\n"
    "on where it is off). Figures are medians over seeds; in brackets the ratio to `{0}`: above 1\n"
    "the part helps. NEES is 1 when the stated covariance is right. Success: within 5 and 1 % of\n"
    "the distance, with 95 % Wilson intervals; p of McNemar's exact test against `{0}`, within 5 "
    "%.\n";

const TableColumns<PairedStatistics>& cell_columns() {
  using Cell = PairedStatistics;
  static const TableColumns<Cell> columns = {
      {"median", "", &Cell::median},
      {"worst", "", &Cell::worst},
      {"ratio", "", &Cell::ratio},
      {"change", "", &Cell::change},
      {"change_low", "", [](const Cell& cell) { return cell.interval.low; }},
      {"change_high", "", [](const Cell& cell) { return cell.interval.high; }},
      {"count", "", &Cell::count}};
  return columns;
}

/// "0.034 (x1), 3 of 7": where estimates lack parts of runs, over the others alone.
std::string paired_text(const PairedStatistics& cell, int digits, std::size_t runs) {
  if (!cell.median) return "-";
  std::string text = fmt::format("{:.{}f}", *cell.median, digits);
  if (cell.ratio) text += fmt::format(" (x{:.3g})", *cell.ratio);
  if (cell.count < runs) text += fmt::format(", {} of {}", cell.count, runs);
  return text;
}

std::string markdown_of(const Ablation& ablation, const Suite& suite) {
  std::string text = fmt::format(kAblationIntroduction, ablation.complete);
  if (!suite.complete) text += fmt::format("\n{}", kInterruptedNote);
  text +=
      "\n## Over all scenarios\n\nGeometric means of the ratios over the runs that are compared: "
      "not those that an estimate lacks a part of; those are lost successes.\n\n" +
      to_markdown(effect_table(ablation));
  for (const AblationCase& each : ablation.cases) {
    const std::size_t runs = each.rows.empty() ? 0 : each.rows.front().runs;
    text += fmt::format("\n## {}, {} runs\n\n{}", each.scenario, runs,
                        each.rows.empty() ? "" : to_markdown(case_table(each)));
  }
  text += "\n## Settings\n\n";
  for (const AblationEffect& each : ablation.effects) {
    text += fmt::format("- `{}`: `{}`\n", each.label, each.changes);
  }
  for (const std::string& line : left_out_lines(suite)) text += fmt::format("- {}\n", line);
  return text + markdown_list(suite.failures);
}

CsvTable csv_of(const Ablation& ablation) {
  std::vector<std::string> header = csv_header(cell_columns(), {"scenario", "variant", "score"});
  header.insert(header.end(), {"runs", "successes"});
  CsvTable table(header);
  for (const AblationCase& each : ablation.cases) {
    for (const AblationRow& row : each.rows) {
      for (std::size_t i = 0; i < kAblationCount; ++i) {
        table.add(each.scenario).add(row.label).add(ablation_scores()[i].key);
        add_cells(cell_columns(), row.cells[i], table);
        table.add(row.runs);
        table.add(row.successes).end_row();
      }
    }
  }
  return table;
}

Json case_json(const AblationCase& each) {
  Json variants = Json::object();
  for (const AblationRow& row : each.rows) {
    Json scores = Json::object();
    for (std::size_t i = 0; i < kAblationCount; ++i) {
      scores[ablation_scores()[i].key] = row_json(cell_columns(), row.cells[i]);
    }
    Json& variant = variants[row.label] = success_json({row.successes, row.runs}, row.strict);
    variant["mcnemar_p"] = row.success_test.p;
    variant["scores"] = std::move(scores);
  }
  return {{"scenario", each.scenario}, {"variants", std::move(variants)}};
}

Json ablation_json(const Ablation& ablation, const Suite& suite) {
  Json json = study_head(kAblationSchema, suite);
  json["estimator"] = ablation.complete;
  json["effects"] = Json::object();
  json["scenarios"] = Json::array();
  for (const AblationEffect& each : ablation.effects) {
    Json ratios = Json::object();
    for (std::size_t i = 0; i < kAblationCount; ++i) {
      ratios[ablation_scores()[i].key] = json_of(each.ratios[i]);
    }
    json["effects"][each.label] = {{"settings", each.changes},
                                   {"mean_ratio", std::move(ratios)},
                                   {"largest_ate_ratio", json_of(each.worst_ratio)},
                                   {"largest_in", each.worst_scenario},
                                   {"runs", each.runs},
                                   {"successes", each.successes},
                                   {"compared", each.compared}};
  }
  json["invalid"] = invalid_json(suite);
  for (const AblationCase& each : ablation.cases) json["scenarios"].push_back(case_json(each));
  return json;
}

}  // namespace

TextTable effect_table(const Ablation& ablation) {
  TableColumns<AblationEffect> columns = {{"", "variant", &AblationEffect::label}};
  for (std::size_t i = 0; i < kAblationCount; ++i) {
    columns.push_back({"", title_with_unit(ablation_scores()[i]),
                       [i](const AblationEffect& each) { return each.ratios[i]; }, "{:.3g}"});
  }
  columns.push_back({"", "largest of ATE yaw", &AblationEffect::worst_ratio, "{:.3g}"});
  columns.push_back({"", "in", &AblationEffect::worst_scenario});
  columns.push_back({"", "success", [](const AblationEffect& each) {
                       return fmt::format("{} of {}", each.successes, each.runs);
                     }});
  columns.push_back({"", "compared", [](const AblationEffect& each) {
                       return fmt::format("{} of {}", each.compared, each.runs);
                     }});
  return rows_table(columns, ablation.effects);
}

TextTable case_table(const AblationCase& each) {
  using Row = AblationRow;
  TableColumns<Row> columns = {{"", "variant", &Row::label}};
  for (std::size_t i = 0; i < kAblationCount; ++i) {
    const Score& score = ablation_scores()[i];
    columns.push_back({"", title_with_unit(score), [i, digits = score.digits](const Row& row) {
                         return paired_text(row.cells[i], digits, row.runs);
                       }});
  }
  add_success_columns(columns);
  columns.push_back(
      {"", "McNemar's p", [](const Row& row) { return row.success_test.p; }, "{:.3g}"});
  return rows_table(columns, each.rows);
}

Result<void> write_ablation(const Ablation& ablation, const Suite& suite,
                            const std::filesystem::path& folder) {
  return write_report({.name = "ablation",
                       .markdown = markdown_of(ablation, suite),
                       .csv = csv_of(ablation),
                       .json = ablation_json(ablation, suite)},
                      folder);
}

}  // namespace aims
