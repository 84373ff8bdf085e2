// SPDX-License-Identifier: BSD-3-Clause
#include "app/sweep_options.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <utility>

#include "app/interrupt.hpp"
#include "app/options.hpp"
#include "app/suite_selection.hpp"
#include "harness/estimator_spec.hpp"

namespace aims {
namespace {

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
                 "estimator., e.g. degeneracy.eta=0:6:13; repeatable");
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

UnitObserver UnitDisplay::observer() {
  return [this](const UnitProgress& progress) {
    show(progress);
    return !interrupted();
  };
}

void UnitDisplay::close() {
  if (open_) fmt::print(stderr, "\n");
  open_ = false;
}

void UnitDisplay::show(const UnitProgress& progress) {
  const bool due = terminal_ || progress.elapsed_s >= shown_at_s_ + kLineEvery ||
                   progress.done == progress.total;
  if (quiet_ || !due) return;
  std::string line = fmt::format("{} of {} units", progress.done, progress.total);
  if (progress.failed > 0) line += fmt::format(", {} failed", progress.failed);
  if (progress.walks > 0) line += fmt::format(", {} walks simulated", progress.walks);
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
