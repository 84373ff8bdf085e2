// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/jobs/job_runner.hpp"
#include "bench/tuning/objective.hpp"
#include "bench/tuning/sweep_plan.hpp"
#include "bench/tuning/sweep_store.hpp"
#include "cli/commands.hpp"
#include "cli/json_output.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/sweep_results.hpp"
#include "cli/terminal.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct SweepArguments {
  SharedOptions shared;
  std::string plan;
  std::string design;
  std::optional<int> samples;
  std::optional<int> design_seed;
  std::optional<double> timeout;
  std::string shard = "1/1";
  bool list = false;
  bool simulate_only = false;
  bool force = false;
  bool json = false;
};

/// Error for options of the design that this design does not read.
Result<void> check_design(const SweepArguments& arguments, const SweepPlan& plan) {
  if (plan.params.empty() && !arguments.design.empty()) {
    return failure("--design: no effect without --param");
  }
  if (plan.design == DesignKind::kGrid && (arguments.samples || arguments.design_seed)) {
    return failure(
        "--samples, --design-seed: no effect on a grid; expected --design random, sobol or lhs");
  }
  return {};
}

/// The plan of the file with the options on top.
Result<SweepPlan> plan_of(const SweepArguments& arguments) {
  SweepPlan plan;
  if (!arguments.plan.empty()) {
    auto loaded = load_plan(arguments.plan);
    if (!loaded) return loaded;
    plan = std::move(*loaded);
  }
  put_on_top(arguments.shared, plan);
  if (!arguments.shared.estimators.empty()) {
    plan.estimators = joined_specs(arguments.shared.estimators);
  }
  if (!arguments.design.empty()) {
    const auto assigned = assign(fields_of(plan), "design", arguments.design);
    if (!assigned) return tl::unexpected(assigned.error());
  }
  plan.samples = arguments.samples.value_or(plan.samples);
  plan.design_seed = arguments.design_seed.value_or(plan.design_seed);
  plan.timeout = arguments.timeout.value_or(plan.timeout);
  if (auto right = check_design(arguments, plan); !right) return tl::unexpected(right.error());
  return plan;
}

void print_counts(const JobRun& run, const SharedOptions& shared, bool merged) {
  print_out("{} jobs done, {} of them failed; {} found finished; {} sequences simulated\n",
            run.done, run.failed, run.reused, run.sequences);
  print_pruned(run.pruned, shared);
  if (run.invalid > 0) {
    print_out("INVALID RUNS: {} jobs, left out of all statistics; why: aims merge {}\n",
              run.invalid, shared.out);
  }
  if (!run.complete) print_out("interrupted: the same command continues\n");
  if (run.failed > 0) {
    print_out("why jobs failed: aims merge {0}; to repeat them: --retry\n", shared.out);
  }
  const fs::path out = shared.out;
  if (merged) {
    print_out("results: {}, sweep.csv, sweep.sqlite\n", (out / "sweep.md").string());
    write_pages_of(out, shared.quiet);
  } else {
    print_out("results: {}; to collect them: aims merge {}\n", (out / "jobs").string(), shared.out);
  }
}

/// Prints the points that are done in the folder; of a complete sweep also writes its results.
/// The points as of --json.
Result<Json> collect(const SharedOptions& shared, bool complete) {
  const std::vector<fs::path> folders = {shared.out};
  const auto sweep = merge_sweeps(folders);
  if (!sweep) return tl::unexpected(sweep.error());
  const Objective objective;
  print_points(*sweep, objective);
  if (complete) {
    if (auto written = write_results(*sweep, objective, shared.out); !written) {
      return tl::unexpected(written.error());
    }
  }
  return points_json(*sweep, objective);
}

int exit_code_of(const JobRun& run) {
  if (!run.complete) return interrupted_code();
  if (run.failed > 0) return kExpectationFailed;
  return run.invalid == 0 ? kOk : kInvalidRun;
}

/// Schema aims.sweep/1; `points` is null of a part of a sweep.
Json sweep_json(const JobRun& run, const SharedOptions& shared, Json points) {
  return {{"schema", "aims.sweep/1"},
          {"out", shared.out},
          {"complete", run.complete},
          {"jobs",
           {{"done", run.done},
            {"failed", run.failed},
            {"invalid", run.invalid},
            {"reused", run.reused}}},
          {"estimators", std::move(points)}};
}

Result<Answer> sweep_command(const SweepArguments& arguments) {
  const auto plan = plan_of(arguments);
  if (!plan) return tl::unexpected(plan.error());
  const auto shard = parse_shard(arguments.shard);
  if (!shard) return tl::unexpected(shard.error());
  const auto jobs = plan_jobs(*plan, arguments.shared.folder);
  if (!jobs) return tl::unexpected(jobs.error());
  if (arguments.list) {
    for (const Job& job : part_of(*jobs, *shard)) {
      print_out("{}\t{}\n", job.id, text_of(job));
    }
    return Answer{kOk, {}};
  }
  JobOptions options = job_options(arguments.shared);
  options.timeout_s = plan->timeout;
  options.simulate_only = arguments.simulate_only;
  watch_interrupt();
  JobDisplay display(arguments.shared.quiet);
  const auto run =
      run_jobs({.jobs = *jobs, .shard = *shard, .plan = plan_text(*plan), .force = arguments.force},
               options, display.observer());
  display.close();
  if (!run) return tl::unexpected(run.error());
  const bool whole = shard->count == 1 && !options.simulate_only;
  Json points;
  if (whole) {
    auto collected = collect(arguments.shared, run->complete);
    if (!collected) return tl::unexpected(collected.error());
    points = std::move(*collected);
  }
  print_counts(*run, arguments.shared, whole && run->complete && !plan->params.empty());
  return Answer{exit_code_of(*run), sweep_json(*run, arguments.shared, std::move(points))};
}

void add_design(Command& command, SweepArguments& arguments) {
  constexpr double kMost = 1e7;
  command.choice("--design", arguments.design, {"grid", "random", "sobol", "lhs"},
                 "How points are laid out (grid); lhs: Latin hypercube");
  command.option("--samples", arguments.samples, {1, kMost},
                 "Points of every design but a grid (64)");
  command.option("--design-seed", arguments.design_seed, {0, 1e9}, "Seed of those points (1)");
  command.option("--timeout", arguments.timeout, {0, 1e9},
                 "Wall time of a job [s]; 0: no limit (0)");
}

}  // namespace

void declare_sweep(Command command, const fs::path& scenarios) {
  auto arguments = std::make_shared<SweepArguments>();
  arguments->shared.folder = scenarios.string();
  command.argument("plan", arguments->plan, "YAML file of these options; the command line wins",
                   Presence::kOptional);
  add_plan_options(
      command, arguments->shared,
      "KEY=LOW:HIGH:COUNT or\nKEY=log(LOW,HIGH,COUNT),\na key of the estimator or of the scenario");
  add_design(command, *arguments);
  add_continued_out(command, arguments->shared, "out/sweep");
  command.option("--shard", arguments->shard, "I/N: part I of N of the jobs (1/1)");
  command.flag("--list", arguments->list, "Print the jobs with their ids, and run nothing");
  command.flag("--simulate-only", arguments->simulate_only,
               "Simulate missing sequences, and run no estimator");
  command.flag(
      "--force", arguments->force,
      "Continue in a folder of another plan, code or scenario\nversion; valid results stay");
  command.exclude("--retry", "--simulate-only");
  add_json(command, arguments->json);
  command.exclude("--list", "--json");
  command.exclude("--list", "--force");
  command.exclude("--list", "--simulate-only");
  command.footer(
      "The same command again continues.\n"
      "Examples:\n"
      "  aims sweep --param degeneracy.eta=0:6:13 --param 'degeneracy.kappa=log(1,100,9)' \\\n"
      "      --scenarios corridor,severity_5 --seeds 1-5 --out out/eta\n"
      "  aims sweep --param links.leg_odometry.loss=0:0.5:6 --estimators aims,leg \\\n"
      "      --scenarios corridor\n"
      "  aims sweep plan.yaml --shard 2/8    # one of eight parts, e.g. on another machine\n"
      "Exit codes: as of aims; 1 when jobs failed.");
  command.action([arguments] {
    return answer("sweep", arguments->json, [&] { return sweep_command(*arguments); });
  });
}

}  // namespace aims
