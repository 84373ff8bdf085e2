// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/paper_study.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/scoring/score_statistics.hpp"
#include "bench/scoring/validity.hpp"

namespace aims {

namespace {

constexpr std::nullopt_t kDash = std::nullopt;

/// Systems that the paper does not have.
void add_others(PaperTable& table) {
  for (const char* estimator : {"leg_kilo", "tfs_plus", "aims_d"}) {
    table.methods.push_back(
        {estimator, "", std::vector<std::optional<double>>(table.scores.size())});
  }
}

PaperTable corridor() {
  PaperTable table;
  table.scenario = "corridor";
  table.title = "Table I, corridor";
  table.scores = {{"m_list_percent.a-b", "M_list a-b [%]"},
                  {"m_list_percent.b-a", "M_list b-a [%]"},
                  {"m_end_m", "M_end [m]"}};
  table.methods = {{"loam", "LOAM", {0.15, 1.73, 16.32}},
                   {"fast_lio2", "FAST-LIO2", {0.12, 0.18, 0.36}},
                   {"lins", "LINS", {0.14, 0.16, 1.29}},
                   {"lego_loam", "LEGO-LOAM", {0.89, 0.92, 0.79}},
                   {"lio_sam", "LIO-SAM", {kDash, kDash, kDash}},
                   {"leg", "Legged Odometry", {6.16, 15.97, 7.01}},
                   {"tfs", "TFS", {14.83, 17.04, 3.44}},
                   {"aims", "Proposed method", {0.07, 0.08, 0.16}}};
  add_others(table);
  return table;
}

PaperTable garage() {
  PaperTable table;
  table.scenario = "garage";
  table.title = "Table II, garage";
  table.scores = {{"m_list_percent.a-d", "M_list a-d [%]"},
                  {"m_list_percent.d-a", "M_list d-a [%]"},
                  {"m_list_percent.d-h", "M_list d-h [%]"},
                  {"m_list_percent.h-d", "M_list h-d [%]"},
                  {"m_end_m", "M_end [m]"}};
  table.methods = {{"loam", "LOAM", {0.26, 10.57, 4.85, 5.13, 23.84}},
                   {"fast_lio2", "FAST-LIO2", {0.20, 0.62, 1.56, 1.69, 0.48}},
                   {"lins", "LINS", {4.29, 4.89, 8.64, 8.38, 0.63}},
                   {"lego_loam", "LEGO-LOAM", {2.50, 3.64, 6.68, 6.27, 0.85}},
                   {"lio_sam", "LIO-SAM", {76.5, kDash, kDash, kDash, kDash}},
                   {"leg", "Legged Odometry", {5.87, 5.92, 6.45, 6.92, 9.70}},
                   {"tfs", "TFS", {8.31, 9.65, 7.44, 7.65, 11.92}},
                   {"aims", "Proposed method", {0.15, 0.14, 0.48, 0.51, 0.29}}};
  add_others(table);
  return table;
}

}  // namespace

const std::vector<PaperTable>& paper_tables() {
  static const std::vector<PaperTable> tables = {corridor(), garage()};
  return tables;
}

const PaperTable* paper_table_of(const std::string& scenario) {
  const auto& tables = paper_tables();
  const auto found = std::ranges::find(tables, scenario, &PaperTable::scenario);
  return found == tables.end() ? nullptr : &*found;
}

std::vector<std::string> paper_estimators() {
  std::vector<std::string> names;
  for (const PaperMethod& method : paper_tables().front().methods)
    names.push_back(method.estimator);
  return names;
}

namespace {

constexpr double kLast = std::numeric_limits<double>::infinity();
constexpr std::uint64_t kPaperBootstrapSeed = 1;

std::vector<RunRecord> valid_runs(std::span<const RunRecord> runs) {
  std::vector<RunRecord> valid;
  std::ranges::copy_if(runs, std::back_inserter(valid),
                       [](const RunRecord& run) { return !invalid_reason(run.scores); });
  return valid;
}

/// The score in each run in which the estimator took part; infinite where it has no value.
std::vector<double> values_of(std::span<const RunRecord> runs, const std::string& estimator,
                              const std::string& score) {
  std::vector<double> values;
  for (const RunRecord& run : runs) {
    if (estimator_in(run, estimator).is_null()) continue;
    values.push_back(find_score(run, estimator, score).value_or(kLast));
  }
  return values;
}

/// The value in the middle, the mean of both middle ones; infinite when one of them is.
double middle(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::optional<double> finite(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

PaperCell cell_of(std::span<const RunRecord> runs, const PaperMethod& method,
                  const std::string& score, std::size_t column) {
  PaperCell cell{method.figures[column], values_of(runs, method.estimator, score), {}, {}};
  if (cell.values.empty()) return cell;
  cell.median = finite(middle(cell.values));
  cell.worst = finite(*std::ranges::max_element(cell.values));
  return cell;
}

PaperSystem system_of(std::span<const RunRecord> runs, const PaperTable& table,
                      const PaperMethod& method) {
  PaperSystem system{method.estimator,
                     method.name,
                     {},
                     finished(runs, method.estimator),
                     successes(runs, method.estimator),
                     success_rate(runs, method.estimator, kStrictSuccessKey),
                     {}};
  for (std::size_t i = 0; i < kPaperHeadline; ++i) {
    const std::vector<double> values = values_of(runs, method.estimator, headline_scores()[i].key);
    system.headline.push_back(values.empty() ? std::nullopt : finite(middle(values)));
  }
  for (std::size_t i = 0; i < table.scores.size(); ++i) {
    system.cells.push_back(cell_of(runs, method, table.scores[i].key, i));
  }
  return system;
}

PaperOrder order_of(std::span<const RunRecord> runs, const PaperTable& table, std::size_t column) {
  PaperOrder order;
  order.score = table.scores[column];
  const PaperTau all = paper_tau(table, column, runs);
  order.tau = all.tau;
  order.systems = all.systems;
  const auto tau_of = [&](std::span<const std::size_t> chosen) {
    std::vector<RunRecord> drawn;
    for (const std::size_t i : chosen) drawn.push_back(runs[i]);
    return paper_tau(table, column, drawn).tau;
  };
  order.interval = bootstrap_interval(runs.size(), tau_of, kPaperBootstrapSeed);
  return order;
}

PaperExperiment experiment_of(const SuiteCase& each, const PaperTable& table) {
  const std::vector<RunRecord> runs = valid_runs(each.runs);
  PaperExperiment experiment{table.scenario, table.title, {}, {}, {}};
  for (const RunRecord& run : runs) experiment.seeds.push_back(run.seed);
  for (const PaperMethod& method : table.methods) {
    PaperSystem system = system_of(runs, table, method);
    if (system.runs > 0) experiment.systems.push_back(std::move(system));
  }
  for (std::size_t i = 0; i < table.scores.size(); ++i) {
    experiment.orders.push_back(order_of(runs, table, i));
  }
  return experiment;
}

}  // namespace

PaperTau paper_tau(const PaperTable& table, std::size_t column, std::span<const RunRecord> runs) {
  std::vector<double> paper;
  std::vector<double> here;
  for (const PaperMethod& method : table.methods) {
    if (method.name.empty()) continue;
    std::vector<double> values = values_of(runs, method.estimator, table.scores[column].key);
    if (values.empty()) continue;
    paper.push_back(method.figures[column].value_or(kLast));
    here.push_back(middle(std::move(values)));
  }
  return {kendall_tau(paper, here), paper.size()};
}

Result<std::vector<PaperExperiment>> paper_study(const Suite& suite) {
  std::vector<PaperExperiment> experiments;
  for (const SuiteCase& each : suite.cases) {
    const PaperTable* table = paper_table_of(each.scenario.name);
    if (table != nullptr && !each.runs.empty()) experiments.push_back(experiment_of(each, *table));
  }
  if (experiments.empty()) {
    return failure("no finished run of the paper's experiments; expected corridor or garage");
  }
  return experiments;
}

}  // namespace aims
