// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "bench/scoring/json_text.hpp"
#include "bench/scoring/report.hpp"
#include "bench/scoring/score_statistics.hpp"
#include "bench/studies/paper_study.hpp"
#include "core/files/csv.hpp"

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

std::string figure_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "–";
}

std::string paper_cell_text(const PaperCell& cell, bool in_paper) {
  const std::string here =
      fmt::format("{} ({})", figure_text(cell.median), figure_text(cell.worst));
  return in_paper ? fmt::format("{} · {}", figure_text(cell.figure), here) : here;
}

std::string tau_interval_text(const Interval& interval) {
  if (!interval.low) return "–";
  return fmt::format("[{:.2f}, {:.2f}]", *interval.low, *interval.high);
}

Json cell_json(const PaperCell& cell) {
  Json values = Json::array();
  for (const double value : cell.values) values.push_back(json_of(value));
  return {{"paper", json_of(cell.figure)},
          {"median", json_of(cell.median)},
          {"worst", json_of(cell.worst)},
          {"values", std::move(values)}};
}

Json system_json(const PaperSystem& system) {
  Json cells = Json::array();
  for (const PaperCell& cell : system.cells) cells.push_back(cell_json(cell));
  Json headline = Json::object();
  for (std::size_t i = 0; i < system.headline.size(); ++i) {
    headline[headline_scores()[i].key] = json_of(system.headline[i]);
  }
  const Interval interval = wilson_interval(system.successes, system.runs);
  return {{"estimator", system.estimator},
          {"method", system.method.empty() ? Json() : Json(system.method)},
          {"runs", system.runs},
          {"successes", system.successes},
          {"success_low", json_of(interval.low)},
          {"success_high", json_of(interval.high)},
          {"successes_1_percent", system.strict.count},
          {"headline", std::move(headline)},
          {"scores", std::move(cells)}};
}

Json order_json(const PaperOrder& order) {
  return {{"key", order.score.key},
          {"title", order.score.title},
          {"systems", order.systems},
          {"tau", json_of(order.tau)},
          {"tau_low", json_of(order.interval.low)},
          {"tau_high", json_of(order.interval.high)}};
}

Json experiment_json(const PaperExperiment& experiment) {
  Json columns = Json::array();
  for (const PaperOrder& order : experiment.orders) columns.push_back(order_json(order));
  Json systems = Json::array();
  for (const PaperSystem& system : experiment.systems) systems.push_back(system_json(system));
  return {{"scenario", experiment.scenario},
          {"title", experiment.title},
          {"seeds", experiment.seeds},
          {"columns", std::move(columns)},
          {"systems", std::move(systems)}};
}

CsvTable paper_csv(const std::vector<PaperExperiment>& experiments) {
  CsvTable table({"scenario", "score", "estimator", "method", "paper", "median", "worst", "runs",
                  "successes"});
  for (const PaperExperiment& experiment : experiments) {
    for (std::size_t i = 0; i < experiment.orders.size(); ++i) {
      for (const PaperSystem& system : experiment.systems) {
        const PaperCell& cell = system.cells[i];
        table.add(experiment.scenario).add(experiment.orders[i].score.key).add(system.estimator);
        table.add(system.method).add(cell.figure).add(cell.median).add(cell.worst);
        table.add(static_cast<std::int64_t>(system.runs))
            .add(static_cast<std::int64_t>(system.successes))
            .end_row();
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
  for (const SuiteFailure& each : suite.failures) text += "\nFAILED: " + text_of(each) + "\n";
  return text;
}

}  // namespace

TextTable system_table(const PaperExperiment& experiment) {
  TextTable table;
  table.header = {"system", "in the paper"};
  for (const Score& score : success_scores()) table.header.emplace_back(score.title);
  for (std::size_t i = 0; i < kPaperHeadline; ++i) {
    table.header.push_back(
        fmt::format("{} {}", headline_scores()[i].title, headline_scores()[i].unit));
  }
  for (const PaperOrder& order : experiment.orders) table.header.push_back(order.score.title);
  for (const PaperSystem& system : experiment.systems) {
    const bool in_paper = !system.method.empty();
    std::vector<std::string> row = {system.estimator, in_paper ? system.method : "–",
                                    SuccessRate{system.successes, system.runs}.text(),
                                    system.strict.text()};
    for (std::size_t i = 0; i < system.headline.size(); ++i) {
      row.push_back(system.headline[i]
                        ? fmt::format("{:.{}f}", *system.headline[i], headline_scores()[i].digits)
                        : "–");
    }
    for (const PaperCell& cell : system.cells) row.push_back(paper_cell_text(cell, in_paper));
    table.rows.push_back(std::move(row));
  }
  return table;
}

TextTable order_table(const std::vector<PaperExperiment>& experiments) {
  TextTable table;
  table.header = {"experiment", "score", "systems", "Kendall's tau", "95 % interval"};
  for (const PaperExperiment& experiment : experiments) {
    for (const PaperOrder& order : experiment.orders) {
      table.rows.push_back({experiment.scenario, order.score.title, std::to_string(order.systems),
                            figure_text(order.tau), tau_interval_text(order.interval)});
    }
  }
  return table;
}

Json paper_json(const std::vector<PaperExperiment>& experiments) {
  Json list = Json::array();
  for (const PaperExperiment& each : experiments) list.push_back(experiment_json(each));
  return {{"schema", kPaperSchema}, {"experiments", std::move(list)}};
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
