// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/tune_plan.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <utility>

#include "bench/jobs/sequence_cache.hpp"
#include "bench/scenario/score_keys.hpp"
#include "bench/scenario/seeds.hpp"
#include "bench/scoring/score_list.hpp"
#include "bench/tuning/range_key.hpp"
#include "bench/tuning/sweep_plan.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/config_dump.hpp"
#include "core/files/yaml_config.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

using Scenarios = std::vector<std::shared_ptr<const Scenario>>;

/// The estimator's own value of each range's key in that scenario.
Result<std::vector<double>> default_values(const TuneTask& task, const Scenario& scenario) {
  auto config = config_with(task.estimator, scenario.estimators);
  if (!config) return tl::unexpected(config.error());
  const Fields fields = fields_of(**config);
  std::vector<double> values;
  for (const ParameterRange& range : task.ranges) {
    values.push_back(number_from<double>(fields.find(range.key)->text()).value_or(0.0));
  }
  return values;
}

/// Settings of every scenario, and who runs.
std::vector<std::string> settings_of(const TunePlan& plan) {
  std::vector<std::string> settings = plan.set;
  settings.push_back(run_setting(std::vector<std::string>{plan.estimator}));
  return settings;
}

Result<void> read_ranges(TuneTask& task, const Scenario& base) {
  if (task.plan.params.empty()) {
    return failure(
        "params: the plan varies nothing; expected ranges, e.g. [\"degeneracy.eta=0:6\"]");
  }
  auto ranges = parse_ranges(task.plan.params, {&task.plan.estimator, 1});
  if (!ranges) return tl::unexpected(ranges.error());
  task.ranges = std::move(*ranges);
  if (auto right = check_ranges(task.ranges, base, {&task.estimator, 1}); !right) return right;
  for (const ParameterRange& range : task.ranges) {
    if (range.low == range.high) {
      return failure(fmt::format("range '{}': one value leaves nothing to tune", text_of(range)));
    }
    if (range.of_estimator) continue;
    return failure(
        fmt::format("range '{}': '{}' is no key of the estimator, and an optimizer that may change "
                    "it would make the task easier; expected keys of the estimator, or aims sweep "
                    "to vary such a key",
                    text_of(range), range.key));
  }
  return {};
}

Result<void> check_objectives(const TunePlan& plan, const Scenarios& scenarios) {
  for (std::size_t i = 0; i < plan.objectives.size(); ++i) {
    const std::string key = fmt::format("objectives.{}.score", i);
    const auto known = check_score(key, plan.objectives[i].score, *scenarios.front());
    if (!known) return known;
    if (auto right = check_direction(key, plan.objectives[i].score); !right) return right;
  }
  return check_optimizer(plan.optimizer, plan.objectives.size());
}

/// Error for seeds that are kept for reporting: also of sequences that are held out, on which a
/// plan is judged before the next one is made.
Result<void> check_seeds(const Scenarios& scenarios, const std::vector<std::uint64_t>& seeds) {
  for (const auto& scenario : scenarios) {
    if (auto right = check_seeds_to_choose_on(*scenario, seeds); !right) return right;
  }
  return {};
}

/// What tells sequences apart: what is simulated, which files of other names may hold too.
std::set<std::string> ids_of(std::span<const ScenarioSeed> sequences) {
  std::set<std::string> ids;
  for (const ScenarioSeed& each : sequences) {
    ids.insert(SequenceCache::id_of(*each.scenario, each.seed));
  }
  return ids;
}

/// Adds those that are not among the sequences yet.
void add_sequences(const Scenarios& scenarios, const std::vector<std::uint64_t>& seeds,
                   std::vector<ScenarioSeed>& sequences) {
  std::set<std::string> known = ids_of(sequences);
  for (const auto& scenario : scenarios) {
    for (const std::uint64_t seed : seeds) {
      if (!known.insert(SequenceCache::id_of(*scenario, seed)).second) continue;
      sequences.push_back({scenario_of_seed(scenario, seed), seed});
    }
  }
}

Result<void> add_held_out(const Scenarios& tuned, const std::vector<std::uint64_t>& tuned_seeds,
                          const fs::path& folder, TuneTask& task) {
  const HeldOut& held = task.plan.held_out;
  auto seeds = tuned_seeds;
  if (!held.seeds.empty()) {
    auto own = parse_seeds(held.seeds);
    if (!own) return failure("held_out.seeds: " + own.error().message);
    seeds = std::move(*own);
    if (auto right = check_seeds(tuned, seeds); !right) return right;
    add_sequences(tuned, seeds, task.held_out);
  }
  if (!held.scenarios.empty() || !held.tags.empty()) {
    const auto others = plan_scenarios(held.scenarios, held.tags, task.plan.set, folder);
    if (!others) return failure("held_out: " + others.error().message);
    if (auto right = check_seeds(*others, seeds); !right) return right;
    Scenarios compared = {tuned.front()};
    compared.insert(compared.end(), others->begin(), others->end());
    if (auto same = check_same_defaults(compared, task.ranges, {&task.estimator, 1}); !same) {
      return failure("held_out: " + same.error().message);
    }
    add_sequences(*others, seeds, task.held_out);
  }
  const std::set<std::string> tuned_on = ids_of(task.sequences);
  for (const ScenarioSeed& sequence : task.held_out) {
    if (!tuned_on.contains(SequenceCache::id_of(*sequence.scenario, sequence.seed))) continue;
    return failure(
        fmt::format("held_out: {} seed {} is also tuned on; expected other seeds or scenarios",
                    sequence.scenario->name, sequence.seed));
  }
  return {};
}

Result<void> check_defaults(const TuneTask& task) {
  Scenarios scenarios;
  for (const ScenarioSeed& sequence : task.sequences) scenarios.push_back(sequence.scenario);
  return check_same_defaults(scenarios, task.ranges, {&task.estimator, 1});
}

}  // namespace

void describe(Fields& f, HeldOut& h) {
  f.texts("scenarios", h.scenarios, {.meaning = "scenarios used for validation only"});
  f.texts("tags", h.tags, {.meaning = "with them, all scenarios with any of these tags"});
  f.text("seeds", h.seeds,
         {.meaning = "of these scenarios and of those tuned on; empty: these alone, tuned seeds"});
}

void describe(Fields& f, OptimizerOptions& o) {
  f.choice("algorithm", o.kind,
           {{"auto", OptimizerKind::kAuto},
            {"cmaes", OptimizerKind::kCmaes},
            {"de", OptimizerKind::kDe},
            {"nsga2", OptimizerKind::kNsga2}},
           {.meaning = "of pagmo; auto: cmaes for one objective, nsga2 for several"});
  f.integer("generations", o.generations,
            {.unit = "-", .range = up_to(100000), .meaning = "after the first population"});
  f.integer("population", o.population,
            {.unit = "-", .range = in_range(5, 100000), .meaning = "points of a generation"});
  f.number("step", o.step,
           {.unit = "-",
            .range = {.min = 0.0, .max = 1.0, .min_included = false},
            .meaning = "first standard deviation of cmaes, in widths of the ranges"});
  f.integer("seed", o.seed,
            {.unit = "-", .range = in_range(0, 2147483647), .meaning = "of its points"});
}

void describe(Fields& f, TunePlan& p) {
  f.text("estimator", p.estimator,
         {.meaning = "NAME or LABEL=NAME+key=value at its default setting"});
  f.texts("params", p.params, {.meaning = "parameters to tune: KEY=LOW:HIGH or KEY=log(LOW,HIGH)"});
  f.texts("scenarios", p.scenarios, {.meaning = "scenario files or names"});
  f.texts("tags", p.tags, {.meaning = "with them, all scenarios with any of these tags"});
  f.text("seeds", p.seeds, {.meaning = "of every scenario: 3, 1-5 or 1,4,7-9"});
  f.group("held_out", p.held_out);
  f.texts("set", p.set, {.meaning = "key=value on top of every scenario"});
  f.list("objectives", p.objectives, "minimized; two or more give a Pareto front");
  f.group("optimizer", p.optimizer);
  f.number("timeout", p.timeout,
           {.unit = "s", .range = up_to(1e7), .meaning = "wall time of a job; 0: any"});
}

Result<TunePlan> load_tune_plan(const fs::path& file) {
  TunePlan plan;
  if (auto loaded = load_config(file, plan); !loaded) return tl::unexpected(loaded.error());
  resolve_scenarios(file, plan.scenarios);
  resolve_scenarios(file, plan.held_out.scenarios);
  resolve_settings(file, plan.set);
  return plan;
}

std::string plan_text(const TunePlan& plan) {
  TunePlan copy = plan;
  return dump_config(fields_of(copy));
}

Result<void> write_plan(const TunePlan& plan, const fs::path& file) {
  return write_file_atomically(file, plan_text(plan));
}

std::string sequences_text(std::span<const ScenarioSeed> sequences) {
  std::vector<std::string> scenarios;
  std::vector<std::string> seeds;
  const auto add = [](std::vector<std::string>& texts, const std::string& text) {
    if (std::find(texts.begin(), texts.end(), text) == texts.end()) texts.push_back(text);
  };
  for (const ScenarioSeed& sequence : sequences) {
    add(scenarios, sequence.scenario->name);
    add(seeds, fmt::format("{}", sequence.seed));
  }
  return fmt::format("{} sequences: {}; seeds {}", sequences.size(), fmt::join(scenarios, ", "),
                     fmt::join(seeds, " "));
}

Result<TuneTask> tune_task(const TunePlan& plan, const fs::path& folder) {
  TuneTask task;
  task.plan = plan;
  auto estimator = parse_estimator_spec(plan.estimator);
  if (!estimator) return failure("estimator: " + estimator.error().message);
  task.estimator = std::move(*estimator);
  const auto scenarios = plan_scenarios(plan.scenarios, plan.tags, settings_of(plan), folder);
  if (!scenarios) return tl::unexpected(scenarios.error());
  if (auto checked = check_objectives(plan, *scenarios); !checked) {
    return tl::unexpected(checked.error());
  }
  if (auto read = read_ranges(task, *scenarios->front()); !read)
    return tl::unexpected(read.error());
  auto defaults = default_values(task, *scenarios->front());
  if (!defaults) return tl::unexpected(defaults.error());
  task.defaults = std::move(*defaults);
  const auto seeds = parse_seeds(plan.seeds);
  if (!seeds) return tl::unexpected(seeds.error());
  if (auto right = check_seeds(*scenarios, *seeds); !right) return tl::unexpected(right.error());
  add_sequences(*scenarios, *seeds, task.sequences);
  if (auto held = add_held_out(*scenarios, *seeds, folder, task); !held) {
    return tl::unexpected(held.error());
  }
  if (auto same = check_defaults(task); !same) return tl::unexpected(same.error());
  return task;
}

namespace {

constexpr const char* kFile = "tune_jobs.csv";
constexpr const char* kHeader = "id";

}  // namespace

Result<void> write_tune_jobs(const std::filesystem::path& folder,
                             const std::set<std::string>& ids) {
  std::string text = std::string(kHeader) + "\n";
  for (const std::string& id : ids) text += id + "\n";
  return write_file_atomically(folder / kFile, text);
}

std::optional<std::set<std::string>> read_tune_jobs(const std::filesystem::path& folder) {
  const auto lines = split(read_file(folder / kFile).value_or(""), '\n');
  if (lines.empty() || lines.front() != kHeader) return std::nullopt;
  return std::set<std::string>(lines.begin() + 1, lines.end());
}

}  // namespace aims
