// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/paper_study.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/metrics/rank_correlation.hpp"
#include "bench/run/score_statistics.hpp"
#include "bench/run/validity.hpp"

namespace aims {
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
    const std::vector<double> values = values_of(runs, method.estimator, kHeadlineScores[i].key);
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
