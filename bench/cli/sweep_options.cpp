// SPDX-License-Identifier: BSD-3-Clause
#include "bench/cli/sweep_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "bench/cli/interrupt.hpp"
#include "bench/cli/options.hpp"
#include "bench/cli/suite_selection.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr double kLineEvery = 10.0;  ///< of a log that is no terminal [s]

}  // namespace

void add_plan_options(CLI::App& command, PlanArguments& arguments) {
  command.add_option("plan", arguments.file, "YAML file with the keys below; options go on top");
  command.add_option("--folder", arguments.folder,
                     "Folder of scenarios, searched with those in it");
  command.add_option("--scenarios", arguments.scenarios, "Scenario files or names")->delimiter(',');
  command.add_option("--tags", arguments.tags, "With them, all scenarios with any of these tags")
      ->delimiter(',');
  command.add_option("--seeds,--seed", arguments.seeds, "Range or list: 1-10, 1,4,7-9 (1)");
  command
      .add_option("--estimators,--estimator", arguments.estimators,
                  "NAME or LABEL=NAME+key=value, keys below estimator. (aims)")
      ->delimiter(',');
  add_repeatable(command, "--over", arguments.over,
                 "KEY=LOW:HIGH:COUNT or KEY=log(LOW,HIGH,COUNT), keys below\n"
                 "estimator. or of the scenario, e.g. degeneracy.eta=0:6:13,\n"
                 "links.leg_odometry.loss=0:0.5:6; repeatable");
  add_repeatable(command, "--set", arguments.set, "key=value on top of every scenario; repeatable");
  command.add_option("--design", arguments.design, "grid, random, sobol or lhs (grid)");
  command.add_option("--samples", arguments.samples, "Points of every design but a grid (64)");
  command.add_option("--design-seed", arguments.design_seed, "Of those points (1)");
  command.add_option("--timeout", arguments.timeout, "Wall time of a unit [s]; 0: any (0)");
}

Result<SweepPlan> plan_of(const PlanArguments& arguments) {
  SweepPlan plan;
  if (!arguments.file.empty()) {
    auto loaded = load_plan(arguments.file);
    if (!loaded) return loaded;
    plan = std::move(*loaded);
  }
  if (!arguments.scenarios.empty() || !arguments.tags.empty()) {
    plan.scenarios = arguments.scenarios;
    plan.tags = arguments.tags;
  }
  if (!arguments.estimators.empty()) plan.estimators = joined_specs(arguments.estimators);
  if (!arguments.over.empty()) plan.over = arguments.over;
  plan.set.insert(plan.set.end(), arguments.set.begin(), arguments.set.end());
  if (!arguments.seeds.empty()) plan.seeds = arguments.seeds;
  // By the plan's own fields, which know what is allowed.
  const Fields fields = fields_of(plan);
  std::vector<std::pair<std::string, std::string>> given;
  if (!arguments.design.empty()) given.emplace_back("design", arguments.design);
  if (arguments.samples) given.emplace_back("samples", fmt::format("{}", *arguments.samples));
  if (arguments.design_seed) {
    given.emplace_back("design_seed", fmt::format("{}", *arguments.design_seed));
  }
  if (arguments.timeout) given.emplace_back("timeout", fmt::format("{}", *arguments.timeout));
  for (const auto& [key, value] : given) {
    if (auto assigned = assign(fields, key, value); !assigned) {
      return tl::unexpected(assigned.error());
    }
  }
  return plan;
}

void add_cache_options(CLI::App& command, CacheArguments& arguments) {
  command.add_option("--cache", arguments.folder,
                     "Folder of simulated walks, shared by all sweeps and tunings\n"
                     "(~/.cache/aims/walks)");
  command.add_option("--cache-limit", arguments.limit_gb,
                     "GB of walks that are kept there; those used longest ago go\n"
                     "first, none that is in use; 0: any (20)");
}

Result<std::uintmax_t> limit_of(const CacheArguments& arguments) {
  constexpr double kMost = 1e9;
  if (!(arguments.limit_gb >= 0.0 && arguments.limit_gb <= kMost)) {
    return failure(
        fmt::format("--cache-limit {}: expected GB, 0 (any) or more", arguments.limit_gb));
  }
  if (arguments.limit_gb == 0.0) return 0;
  return static_cast<std::uintmax_t>(std::max(1.0, 1e9 * arguments.limit_gb));
}

void print_pruned(const CachePruned& pruned, const CacheArguments& arguments) {
  const fs::path folder =
      arguments.folder.empty() ? SequenceCache::default_folder() : fs::path(arguments.folder);
  if (pruned.sequences > 0) {
    fmt::print(
        "{}: {} walks that were used longest ago are removed, {:.3g} GB (--cache-limit {})\n",
        folder.string(), pruned.sequences, 1e-9 * static_cast<double>(pruned.bytes),
        arguments.limit_gb);
  }
  const double left_gb = 1e-9 * static_cast<double>(pruned.left);
  if (arguments.limit_gb == 0.0 || left_gb <= arguments.limit_gb) return;
  fmt::print("{}: {:.3g} GB of walks are in use, more than --cache-limit {}\n", folder.string(),
             left_gb, arguments.limit_gb);
}

JobObserver JobDisplay::observer() {
  return [this](const JobProgress& progress) {
    show(progress);
    return !interrupted();
  };
}

void JobDisplay::close() {
  if (open_) fmt::print(stderr, "\n");
  open_ = false;
}

void JobDisplay::show(const JobProgress& progress) {
  const bool due = terminal_ || progress.elapsed_s >= shown_at_s_ + kLineEvery ||
                   progress.done == progress.total;
  if (quiet_ || !due) return;
  std::string line = fmt::format("{} of {} units", progress.done, progress.total);
  if (progress.failed > 0) line += fmt::format(", {} failed", progress.failed);
  if (progress.sequences > 0) line += fmt::format(", {} sequences simulated", progress.sequences);
  if (line == shown_ && !terminal_) return;
  shown_ = line;
  shown_at_s_ = progress.elapsed_s;
  line += ", " + duration_text(progress.elapsed_s);
  if (progress.left_s) line += fmt::format(", {} left", duration_text(*progress.left_s));
  fmt::print(stderr, "{}{}{}", terminal_ ? "\r" : "", line, terminal_ ? "    " : "\n");
  open_ = terminal_;
  std::fflush(stderr);
}

}  // namespace aims
