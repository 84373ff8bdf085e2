// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/exit_code.hpp"
#include "bench/cli/interrupt.hpp"
#include "bench/cli/options.hpp"
#include "bench/cli/sweep_options.hpp"
#include "bench/jobs/sweep.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct SweepArguments {
  PlanArguments plan;
  std::string shard = "1/1";
  std::vector<std::string> only;
  std::string out = "out/sweep";
  CacheArguments cache;
  int jobs = default_jobs();
  bool list = false;
  bool simulate_only = false;
  bool retry = false;
  bool renew = false;
  bool quiet = false;
};

Result<SweepOptions> options_of(const SweepArguments& arguments) {
  SweepOptions options;
  options.out = arguments.out;
  options.cache = arguments.cache.folder;
  const auto limit = limit_of(arguments.cache);
  if (!limit) return tl::unexpected(limit.error());
  options.cache_limit = *limit;
  options.jobs = arguments.jobs;
  options.retry = arguments.retry;
  options.renew = arguments.renew;
  options.simulate_only = arguments.simulate_only;
  const auto shard = parse_shard(arguments.shard);
  if (!shard) return tl::unexpected(shard.error());
  options.shard = *shard;
  return options;
}

void print_jobs(std::span<const Job> units) {
  for (const Job& unit : units) {
    fmt::print("{}\t{}\n", unit.id, text_of(unit));
  }
}

void print_report(const JobRun& run, const SweepArguments& arguments) {
  fmt::print("{} units done, {} of them failed; {} found finished; {} walks simulated\n", run.done,
             run.failed, run.reused, run.sequences);
  print_pruned(run.pruned, arguments.cache);
  if (!run.complete) fmt::print("interrupted: the same command continues\n");
  if (run.failed > 0) fmt::print("why: aims merge {0}; again: --retry\n", arguments.out);
  fmt::print("results: {}; into one database: aims merge {}\n",
             (fs::path(arguments.out) / "jobs").string(), arguments.out);
}

int sweep_command(const SweepArguments& arguments, const fs::path& folder) {
  const auto plan = plan_of(arguments.plan);
  if (!plan) return bad_input("sweep", plan.error());
  auto options = options_of(arguments);
  if (!options) return bad_input("sweep", options.error());
  options->timeout_s = plan->timeout;
  const auto units =
      plan_jobs(*plan, arguments.plan.folder.empty() ? folder : fs::path(arguments.plan.folder));
  if (!units) return bad_input("sweep", units.error());
  if (arguments.list) {
    print_jobs(part_of(*units, options->shard));
    return kOk;
  }
  watch_interrupt();
  JobDisplay display(arguments.quiet);
  const auto run = run_sweep(plan_text(*plan), *units, *options, display.observer());
  display.close();
  if (!run) return bad_input("sweep", run.error());
  print_report(*run, arguments);
  if (!run->complete) return kInterrupted;
  return run->failed == 0 ? kOk : kGateFailed;
}

}  // namespace

void add_sweep_command(CLI::App& app, const fs::path& scenario_folder, int& exit_code) {
  auto* command = app.add_subcommand(
      "sweep",
      "Evaluate estimators over ranges of their parameters or the simulation's; continues what was "
      "interrupted");
  auto arguments = std::make_shared<SweepArguments>();
  add_plan_options(*command, arguments->plan);
  command->add_option("--out", arguments->out, "Folder that is filled or continued (out/sweep)");
  add_cache_options(*command, arguments->cache);
  add_jobs_option(*command, arguments->jobs,
                  "Processes at a time; the results do not depend on it");
  command->add_option("--shard", arguments->shard, "I/N: part I of N of the units");
  command->add_flag("--list", arguments->list, "Print the units with their ids, and do nothing");
  command->add_flag("--walks-only", arguments->simulate_only,
                    "Simulate the walks that are missing, and evaluate nothing");
  command->add_flag("--retry", arguments->retry, "Do units that failed before again");
  command->add_flag("--renew", arguments->renew,
                    "Go on in a folder of another plan, code or scenarios");
  command->add_flag("--quiet", arguments->quiet, "No progress");
  command->footer(
      "Examples:\n"
      "  aims sweep --over degeneracy.eta=0:6:13 --over 'degeneracy.kappa=log(1,100,9)' \\\n"
      "      --scenarios corridor,severity_5 --seeds 1-5 --out out/eta\n"
      "  aims sweep --over links.leg_odometry.loss=0:0.5:6 --estimators aims,leg --scenarios "
      "corridor\n"
      "  aims sweep plan.yaml --jobs 2\n"
      "  aims sweep plan.yaml --shard 2/8          # one of eight parts, see docs/scaling.md\n"
      "The same command again continues. Exit codes: as of aims; 1 when units failed.");
  command->callback([arguments, scenario_folder, &exit_code] {
    exit_code = sweep_command(*arguments, scenario_folder);
  });
}

}  // namespace aims
