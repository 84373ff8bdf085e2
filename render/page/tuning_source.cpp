// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/tuning_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "bench/scenario/seeds.hpp"
#include "bench/scoring/json_text.hpp"
#include "bench/tuning/sweep_plan.hpp"
#include "bench/tuning/tune_plan.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/csv_columns.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTunePlan = "tune.yaml";
constexpr const char* kSweepPlan = "plan.yaml";
constexpr const char* kUnitList = "jobs.csv";
constexpr const char* kTunePoints = "tune.csv";

/// Names of scenarios that a plan gives by name or file.
std::set<std::string> names_of(const std::vector<std::string>& scenarios) {
  std::set<std::string> names;
  for (const std::string& each : scenarios) names.insert(fs::path(each).stem().string());
  return names;
}

/// Sequences that a plan tunes on; a plan with tags does not name its scenarios.
class TunedSequences {
 public:
  static Result<TunedSequences> of(const TunePlan& plan) {
    const auto seeds = parse_seeds(plan.seeds);
    if (!seeds) return tl::unexpected(seeds.error());
    TunedSequences sequences;
    sequences.seeds_.insert(seeds->begin(), seeds->end());
    sequences.scenarios_ = names_of(plan.scenarios);
    sequences.others_ = names_of(plan.held_out.scenarios);
    sequences.by_tags_ = !plan.tags.empty();
    return sequences;
  }

  bool contain(const std::string& scenario, std::uint64_t seed) const {
    if (!seeds_.contains(seed)) return false;
    return scenarios_.contains(scenario) || (by_tags_ && !others_.contains(scenario));
  }

 private:
  std::set<std::uint64_t> seeds_;
  std::set<std::string> scenarios_;
  std::set<std::string> others_;
  bool by_tags_ = false;
};

/// The tuning's plan as that of a sweep, which the analysis of points reads.
std::string as_sweep(const TunePlan& plan) {
  SweepPlan sweep;
  sweep.scenarios = plan.scenarios;
  sweep.tags = plan.tags;
  sweep.seeds = plan.seeds;
  sweep.estimators = {plan.estimator};
  sweep.params = plan.params;
  sweep.set = plan.set;
  return plan_text(sweep);
}

/// Points by values; none while there is no tune.csv that fits.
std::map<std::vector<double>, TunedPoint> points_in(const fs::path& file, const TunePlan& plan) {
  std::map<std::vector<double>, TunedPoint> points;
  const auto table = CsvColumns::read(file);
  if (!table) return points;
  std::vector<std::vector<double>> columns;
  for (const std::string& text : plan.params) {
    const auto range = parse_range(text);
    auto column = range ? table->numbers(range->key) : failure("no range");
    if (!column || column->size() != table->rows()) return {};
    columns.push_back(std::move(*column));
  }
  const auto generation = table->numbers("generation");
  if (!generation || generation->size() != table->rows()) return {};
  for (std::size_t i = 0; i < table->rows(); ++i) {
    std::vector<double> values;
    for (const auto& column : columns) values.push_back(column[i]);
    points.emplace(std::move(values), TunedPoint{i, (*generation)[i]});
  }
  return points;
}

/// A unit's file as one of a sweep, where it is one.
Result<MergedJob> unit_of(const JobStore& folder, const std::string& id) {
  auto json = folder.read(id);
  const bool whole = json && result_in(*json) && member(*json, "settings").is_object() &&
                     member(*json, "seed").is_number_unsigned() &&
                     !text_in(*json, "scenario").empty();
  if (!whole) return failure(id);
  const std::string seed = fmt::format("{}", (*json)["seed"].get<std::uint64_t>());
  return MergedJob{{id, text_in(*json, "scenario"), seed, "", text_in(*json, "estimator")},
                   std::move(*json)};
}

Result<TuningSource> read_tune(const fs::path& folder) {
  TuningSource source;
  source.tuned = true;
  const auto plan = load_tune_plan(folder / kTunePlan);
  if (!plan) return tl::unexpected(plan.error());
  const auto sequences = TunedSequences::of(*plan);
  if (!sequences) return failure((folder / kTunePlan).string() + ": " + sequences.error().message);
  source.plan = plan_text(*plan);
  const HeldOut& others = plan->held_out;
  source.holds_out = !(others.scenarios.empty() && others.tags.empty() && others.seeds.empty());
  source.objectives = plan->objectives;
  source.units.plans = {as_sweep(*plan)};
  source.held_out.plans = source.units.plans;
  source.points = points_in(folder / kTunePoints, *plan);
  const JobStore units(folder);
  const auto asked_for = read_tune_jobs(folder);
  std::size_t broken = 0;
  std::size_t earlier = 0;
  for (const std::string& id : units.ids()) {
    if (asked_for && !asked_for->contains(id)) {
      ++earlier;
      continue;
    }
    auto unit = unit_of(units, id);
    if (!unit) {
      ++broken;
      continue;
    }
    const bool tuned = sequences->contain(unit->listed.scenario, unit->file["seed"]);
    (tuned ? source.units : source.held_out).jobs.push_back(std::move(*unit));
  }
  if (broken > 0) source.notes.push_back(fmt::format("{} job files cannot be read", broken));
  if (earlier > 0) {
    source.notes.push_back(
        fmt::format("{} jobs of an earlier plan in this folder do not count", earlier));
  }
  return source;
}

Result<TuningSource> read_sweep(const fs::path& folder) {
  auto units = merge_sweeps(std::array{folder});
  if (!units) return tl::unexpected(units.error());
  auto objective = objective_in(folder);
  if (!objective) return tl::unexpected(objective.error());
  return merged_source(std::move(*units), std::move(*objective));
}

}  // namespace

TuningSource merged_source(MergedSweep units, Objective objective) {
  TuningSource source;
  source.units = std::move(units);
  source.plan = fmt::format("{}", fmt::join(source.units.plans, "\n"));
  source.objectives = {std::move(objective)};
  return source;
}

bool holds_tuning(const fs::path& folder) {
  std::error_code ignored;
  const bool sweep =
      fs::exists(folder / kSweepPlan, ignored) && fs::exists(folder / kUnitList, ignored);
  return sweep || fs::exists(folder / kTunePlan, ignored);
}

Result<TuningSource> read_tuning(const fs::path& folder) {
  std::error_code ignored;
  if (fs::exists(folder / kTunePlan, ignored)) return read_tune(folder);
  if (holds_tuning(folder)) return read_sweep(folder);
  return failure(folder.string() + ": holds neither a sweep (plan.yaml, jobs.csv) nor a tuning " +
                 "(tune.yaml)");
}

}  // namespace aims
