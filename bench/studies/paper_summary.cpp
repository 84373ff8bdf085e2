// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "bench/scoring/report.hpp"
#include "bench/studies/paper_study.hpp"
#include "bench/studies/success_columns.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPaperIntroduction =
    "# The paper's tables, repeated\n"
    "\n"
    "Each cell: the paper's figure · the median here (the worst). A dash is a figure that the "
    "paper\n"
    "does not have, or a system without a value in most runs. Kendall's tau compares the order of\n"
    "the paper's systems: 1 the same, 0 unrelated, -1 opposite; 95 % bootstrap interval over "
    "seeds.\n"
    "ATE yaw, ATE start and heading: medians here. Success: runs within 5 and 1 % of the distance\n"
    "travelled, with the 95 % Wilson interval.\n";

constexpr const char* kNone = "–";

std::string paper_cell_text(const PaperCell& cell, bool in_paper) {
  const auto text = [](const auto& value) { return number_text(value, "{:.2f}", kNone); };
  const std::string here = fmt::format("{} ({})", text(cell.median), text(cell.worst));
  return in_paper ? fmt::format("{} · {}", text(cell.figure), here) : here;
}

const TableColumns<PaperCell>& cell_columns() {
  static const TableColumns<PaperCell> columns = {{"paper", "", &PaperCell::figure},
                                                  {"median", "", &PaperCell::median},
                                                  {"worst", "", &PaperCell::worst}};
  return columns;
}

/// One score of one experiment.
struct OrderRow {
  std::string scenario;
  PaperOrder order;
};

const TableColumns<OrderRow>& order_columns() {
  using Row = OrderRow;
  static const TableColumns<Row> columns = {
      {"", "experiment", &Row::scenario},
      {"key", "", [](const Row& row) { return row.order.score.key; }},
      {"title", "score", [](const Row& row) { return row.order.score.title; }},
      {"systems", "systems", [](const Row& row) { return row.order.systems; }},
      {"tau", "Kendall's tau", [](const Row& row) { return row.order.tau; }, "{:.2f}"},
      {"tau_low", "", [](const Row& row) { return row.order.interval.low; }},
      {"tau_high", "", [](const Row& row) { return row.order.interval.high; }},
      {"", "95 % interval",
       [](const Row& row) { return interval_text(row.order.interval, "{:.2f}", kNone); }}};
  return columns;
}

Json cell_json(const PaperCell& cell) {
  Json json = row_json(cell_columns(), cell);
  json["values"] = json_array(cell.values, [](double value) { return json_of(value); });
  return json;
}

Json system_json(const PaperSystem& system) {
  Json json = {{"estimator", system.estimator},
               {"method", system.method.empty() ? Json() : Json(system.method)}};
  json.update(success_json({system.successes, system.runs}, system.strict));
  json["headline"] = Json::object();
  for (std::size_t i = 0; i < system.headline.size(); ++i) {
    json["headline"][headline_scores()[i].key] = json_of(system.headline[i]);
  }
  json["scores"] = json_array(system.cells, cell_json);
  return json;
}

Json experiment_json(const PaperExperiment& experiment) {
  Json columns = json_array(experiment.orders, [&experiment](const PaperOrder& order) {
    return row_json(order_columns(), {experiment.scenario, order});
  });
  return {{"scenario", experiment.scenario},
          {"title", experiment.title},
          {"seeds", experiment.seeds},
          {"columns", std::move(columns)},
          {"systems", json_array(experiment.systems, system_json)}};
}

CsvTable paper_csv(const std::vector<PaperExperiment>& experiments) {
  std::vector<std::string> header =
      csv_header(cell_columns(), {"scenario", "score", "estimator", "method"});
  header.insert(header.end(), {"runs", "successes"});
  CsvTable table(header);
  for (const PaperExperiment& experiment : experiments) {
    for (std::size_t i = 0; i < experiment.orders.size(); ++i) {
      for (const PaperSystem& system : experiment.systems) {
        table.add(experiment.scenario).add(experiment.orders[i].score.key).add(system.estimator);
        table.add(system.method);
        add_cells(cell_columns(), system.cells[i], table);
        table.add(system.runs).add(system.successes).end_row();
      }
    }
  }
  return table;
}

std::string paper_markdown(const std::vector<PaperExperiment>& experiments, const Suite& suite) {
  std::string text = kPaperIntroduction;
  for (const PaperExperiment& experiment : experiments) {
    text += fmt::format("\n## {}\n\n{}, seeds {}\n\n{}", experiment.title, experiment.scenario,
                        fmt::join(experiment.seeds, ", "), to_markdown(system_table(experiment)));
  }
  text += "\n## Agreement with the paper's order\n\n" + to_markdown(order_table(experiments));
  for (const std::string& line : left_out_lines(suite)) text += "\n" + line + "\n";
  return text + markdown_list(suite.failures);
}

}  // namespace

TextTable system_table(const PaperExperiment& experiment) {
  using System = PaperSystem;
  TableColumns<System> columns = {
      {"", "system", &System::estimator},
      {"", "in the paper", [](const System& s) { return s.method.empty() ? kNone : s.method; }}};
  add_success_columns(columns);
  for (std::size_t i = 0; i < kPaperHeadline; ++i) {
    const Score& score = headline_scores()[i];
    columns.push_back({"", fmt::format("{} {}", score.title, score.unit),
                       [i](const System& s) { return s.headline[i]; },
                       fmt::format("{{:.{}f}}", score.digits)});
  }
  for (std::size_t i = 0; i < experiment.orders.size(); ++i) {
    columns.push_back({"", experiment.orders[i].score.title, [i](const System& s) {
                         return paper_cell_text(s.cells[i], !s.method.empty());
                       }});
  }
  return rows_table(columns, experiment.systems, kNone);
}

TextTable order_table(const std::vector<PaperExperiment>& experiments) {
  std::vector<OrderRow> rows;
  for (const PaperExperiment& experiment : experiments) {
    for (const PaperOrder& order : experiment.orders) rows.push_back({experiment.scenario, order});
  }
  return rows_table(order_columns(), rows, kNone);
}

Json paper_json(const std::vector<PaperExperiment>& experiments) {
  return {{"schema", kPaperSchema}, {"experiments", json_array(experiments, experiment_json)}};
}

Result<void> write_paper(const std::vector<PaperExperiment>& experiments, const Suite& suite,
                         const fs::path& folder) {
  return write_report({.name = "paper",
                       .markdown = paper_markdown(experiments, suite),
                       .csv = paper_csv(experiments),
                       .json = paper_json(experiments)},
                      folder);
}

}  // namespace aims
