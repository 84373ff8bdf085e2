// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/tune.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "bench/tuning/analysis.hpp"
#include "bench/tuning/batch_progress.hpp"
#include "bench/tuning/effect.hpp"
#include "bench/tuning/optimizer.hpp"
#include "bench/tuning/tune_plan.hpp"

namespace aims {
namespace {

/// Of a point without an objective: worse than any.
constexpr double kNoObjective = 1e12;

/// Where the search starts: at the defaults, or as near as the ranges allow.
std::vector<double> start_of(const TuneTask& task) {
  std::vector<double> fractions;
  for (std::size_t i = 0; i < task.ranges.size(); ++i) {
    fractions.push_back(std::clamp(fraction_of(task.ranges[i], task.defaults[i]), 0.0, 1.0));
  }
  return fractions;
}

/// The point in the parameters' own units, whole where they are.
std::vector<double> values_of(const TuneTask& task, const std::vector<double>& fractions) {
  if (fractions == start_of(task) && defaults_outside(task).empty()) return task.defaults;
  std::vector<double> values;
  for (std::size_t i = 0; i < fractions.size(); ++i) {
    values.push_back(value_at(task.ranges[i], fractions[i]));
  }
  const auto settings = settings_of(task, values);
  for (std::size_t i = 0; i < settings.size(); ++i) values[i] = std::stod(settings[i].second);
  return values;
}

/// The runs of one estimator in one objective.
std::vector<RunScore> runs_in(const std::vector<std::vector<RunScore>>& by_sequence,
                              std::size_t objective) {
  std::vector<RunScore> runs;
  for (const auto& scores : by_sequence) runs.push_back(scores[objective]);
  return runs;
}

class Tuning {
 public:
  Tuning(const TuneTask& task, const RunOnSequences& run) : run_(run) { result_.task = task; }

  Result<TuneResult> operator()() {
    auto defaults = add_defaults();
    if (!defaults) return tl::unexpected(defaults.error());
    if (!*defaults) return std::move(result_);
    const TuneTask& task = result_.task;
    const BatchFunction batch = [this](const Points& points) { return evaluate(points); };
    const auto run = minimize(batch, start_of(task), result_.tables.size(), task.plan.optimizer);
    if (!run) return tl::unexpected(run.error());
    result_.complete = run->complete;
    result_.converged = run->converged;
    add_generations(run->generation);
    choose();
    if (auto kept = keep_idle_defaults(); !kept) return tl::unexpected(kept.error());
    if (auto held = add_held_out(); !held) return tl::unexpected(held.error());
    return std::move(result_);
  }

 private:
  /// False when it was interrupted.
  Result<bool> add_defaults() {
    const TuneTask& task = result_.task;
    result_.tables.assign(task.plan.objectives.size(), empty_table(task, task.sequences));
    auto scores = run_({&task.estimator, 1}, task.sequences);
    if (!scores) return tl::unexpected(scores.error());
    result_.complete = scores->has_value();
    if (!result_.complete) return false;
    for (std::size_t i = 0; i < result_.tables.size(); ++i) {
      ResponseTable& table = result_.tables[i];
      table.default_runs = runs_in((**scores).front(), i);
      Objective& objective = result_.task.plan.objectives[i];
      objective = objective_for(objective, table);
      if (const auto failed = failed_lines(table); failed.size() == table.cases.size()) {
        return failure("no run with the default values ended: " + failed.front());
      }
      if (objective_at(table, objective, kDefaults, cases_of(table, ""))) {
        table.points = {task.defaults};
        table.runs = {table.default_runs};
        continue;
      }
      const auto left_out = left_out_lines(table);
      if (!left_out.empty()) return failure("no valid run is left: " + left_out.front());
      return failure(fmt::format(
          "objectives.{}: no run of {} has the score '{}'; expected a key of scores.json", i,
          text_of(task.estimator), objective.score));
    }
    result_.generation = {0};
    return true;
  }

  /// Of the points that the search adds to the defaults.
  void add_generations(const std::vector<int>& of_search) {
    for (std::size_t k = 0; k < of_search.size() && k < is_new_.size(); ++k) {
      if (is_new_[k]) result_.generation.push_back(of_search[k]);
    }
  }

  /// The point that is better than all others, the defaults included; of several objectives the
  /// front.
  void choose() {
    const auto& tables = result_.tables;
    const auto& objectives = result_.task.plan.objectives;
    if (result_.generation.size() < 2) return;
    if (tables.size() == 1) {
      const auto all = cases_of(tables[0], "");
      const std::size_t least = *least_point(tables[0], objectives[0], all);
      result_.chosen = {least == kDefaults ? 0 : least};
      return;
    }
    Points values(tables[0].points.size());
    for (std::size_t i = 0; i < tables.size(); ++i) {
      const auto all = cases_of(tables[i], "");
      for (std::size_t k = 0; k < values.size(); ++k) {
        values[k].push_back(objective_at(tables[i], objectives[i], k, all).value_or(kNoObjective));
      }
    }
    result_.chosen = pareto_front(values);
  }

  /// Where the chosen point has other values than the defaults of parameters that may have no
  /// effect, the one with the defaults is run and chosen, unless it turns out to be worse.
  Result<void> keep_idle_defaults() {
    if (result_.tables.size() != 1 || result_.chosen.empty() || !result_.complete) return {};
    const TuneTask& task = result_.task;
    ResponseTable& table = result_.tables.front();
    std::vector<double> values = table.points[result_.chosen.front()];
    const std::vector<bool> idle = alike_in_pairs(table);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (idle[i]) values[i] = task.defaults[i];
    }
    if (std::ranges::find(table.points, values) != table.points.end()) return {};
    const EstimatorSpec estimator = estimator_at(task, values);
    auto scores = run_({&estimator, 1}, task.sequences);
    if (!scores) return tl::unexpected(scores.error());
    result_.complete = scores->has_value();
    if (!result_.complete) return {};
    table.points.push_back(values);
    table.runs.push_back(runs_in((**scores).front(), 0));
    result_.generation.push_back(result_.generation.back());
    choose();
    return {};
  }

  Result<std::optional<Points>> evaluate(const Points& points) {
    const TuneTask& task = result_.task;
    std::vector<EstimatorSpec> estimators;
    for (const auto& point : points) {
      estimators.push_back(estimator_at(task, values_of(task, point)));
    }
    auto scores = run_(estimators, task.sequences);
    if (!scores) return tl::unexpected(scores.error());
    if (!*scores) return std::optional<Points>();
    Points objectives(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      const std::vector<double> values = values_of(task, points[k]);
      is_new_.push_back(values != task.defaults);
      for (std::size_t i = 0; i < result_.tables.size(); ++i) {
        ResponseTable& table = result_.tables[i];
        if (is_new_.back()) {
          table.points.push_back(values);
          table.runs.push_back(runs_in((**scores)[k], i));
        }
        const std::size_t row = is_new_.back() ? table.points.size() - 1 : 0;
        objectives[k].push_back(
            objective_at(table, task.plan.objectives[i], row, cases_of(table, ""))
                .value_or(kNoObjective));
      }
    }
    return objectives;
  }

  Result<void> add_held_out() {
    const TuneTask& task = result_.task;
    if (task.held_out.empty() || result_.chosen.empty() || !result_.complete) return {};
    if (keeps_defaults(result_)) return {};
    std::vector<EstimatorSpec> estimators = {task.estimator};
    std::vector<std::vector<double>> points;
    for (const std::size_t k : result_.chosen) {
      points.push_back(result_.tables.front().points[k]);
      estimators.push_back(estimator_at(task, points.back()));
    }
    auto scores = run_(estimators, task.held_out);
    if (!scores) return tl::unexpected(scores.error());
    result_.complete = scores->has_value();
    if (!result_.complete) return {};
    for (std::size_t i = 0; i < result_.tables.size(); ++i) {
      ResponseTable table = empty_table(task, task.held_out);
      table.points = points;
      table.default_runs = runs_in((**scores).front(), i);
      for (std::size_t k = 1; k < estimators.size(); ++k) {
        table.runs.push_back(runs_in((**scores)[k], i));
      }
      result_.held_out.push_back(std::move(table));
    }
    return {};
  }

  const RunOnSequences& run_;
  std::vector<bool> is_new_;  ///< of each point of the search: not the defaults
  TuneResult result_;
};

/// By sequence first, so that neighbours share an open sequence.
std::vector<Job> jobs_of(std::span<const EstimatorSpec> estimators,
                         std::span<const ScenarioSeed> sequences) {
  std::vector<Job> jobs;
  for (const ScenarioSeed& sequence : sequences) {
    for (const EstimatorSpec& estimator : estimators) {
      jobs.push_back(make_job(sequence.scenario, sequence.seed, estimator));
    }
  }
  return jobs;
}

}  // namespace

bool keeps_defaults(const TuneResult& result) {
  return result.chosen == std::vector<std::size_t>{0};
}

std::vector<std::string> defaults_outside(const TuneTask& task) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < task.ranges.size(); ++i) {
    const ParameterRange& range = task.ranges[i];
    const double value = task.defaults[i];
    if (range.low <= value && value <= range.high) continue;
    lines.push_back(fmt::format(
        "the default {} of {} lies outside of its range {} to {}: the search starts at {}, "
        "and point 0, the defaults, was run at {}",
        value, range.key, range.low, range.high, value < range.low ? range.low : range.high,
        value));
  }
  return lines;
}

Result<TuneResult> tune(const TuneTask& task, const RunOnSequences& run) {
  return Tuning(task, run)();
}

std::size_t expected_jobs(const TuneTask& task) {
  const OptimizerOptions& optimizer = task.plan.optimizer;
  const auto population = static_cast<std::size_t>(optimizer.population);
  const auto generations = static_cast<std::size_t>(optimizer.generations) + 1;
  const std::size_t validated = task.plan.objectives.size() > 1 ? population : 1;
  return task.sequences.size() * (1 + generations * population) +
         task.held_out.size() * (1 + validated);
}

RunOnSequences run_by_jobs(JobRunner& runner, const JobObserver& observer,
                           const std::vector<Objective>& objectives, std::size_t expected) {
  const auto batches = std::make_shared<BatchProgress>(expected);
  const auto asked_for = std::make_shared<std::set<std::string>>();
  return [&runner, observer, objectives, batches, asked_for](
             std::span<const EstimatorSpec> estimators,
             std::span<const ScenarioSeed> sequences) -> Result<std::optional<SequenceScores>> {
    const std::vector<Job> jobs = jobs_of(estimators, sequences);
    for (const Job& job : jobs) asked_for->insert(job.id);
    if (auto listed = write_tune_jobs(runner.store().path(), *asked_for); !listed) {
      return tl::unexpected(listed.error());
    }
    const auto run = runner.run(jobs, [&](const JobProgress& progress) {
      return observer(batches->overall(jobs.size(), progress));
    });
    if (!run) return tl::unexpected(run.error());
    batches->end(jobs.size(), *run);
    if (!run->complete) return std::optional<SequenceScores>();
    const std::vector<std::vector<RunScore>> none(sequences.size());
    SequenceScores scores(estimators.size(), none);
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      const auto result = runner.store().find(jobs[i].id);
      auto& of_unit = scores[i % estimators.size()][i / estimators.size()];
      for (const Objective& each : objectives) {
        of_unit.push_back(result ? run_score(*result, each.score) : RunScore{});
      }
    }
    return scores;
  };
}

EstimatorSpec estimator_at(const TuneTask& task, std::span<const double> point) {
  const bool any = !task.sequences.empty();
  return spec_at(task.estimator, task.ranges, point,
                 any ? task.sequences.front().scenario->estimators : EstimatorConfigs());
}

std::vector<std::pair<std::string, std::string>> settings_of(const TuneTask& task,
                                                             std::span<const double> point) {
  TuneTask varied_alone = task;
  varied_alone.estimator.settings.clear();
  return estimator_at(varied_alone, point).settings;
}

ResponseTable empty_table(const TuneTask& task, std::span<const ScenarioSeed> sequences) {
  ResponseTable table;
  table.ranges = task.ranges;
  table.defaults = task.defaults;
  for (const ScenarioSeed& sequence : sequences) {
    const std::string& family = sequence.scenario->family;
    table.cases.push_back({sequence.scenario->name,
                           family.empty() ? sequence.scenario->name : family, sequence.seed});
  }
  return table;
}

}  // namespace aims
