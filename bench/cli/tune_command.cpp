// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/exit_code.hpp"
#include "bench/cli/interrupt.hpp"
#include "bench/cli/options.hpp"
#include "bench/cli/sweep_options.hpp"
#include "bench/tuning/tune.hpp"
#include "bench/tuning/tune_report.hpp"
#include "core/files/folder_lock.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct TuneArguments {
  std::string plan;
  std::string folder;
  std::string out = "out/tune";
  std::string apply;
  CacheArguments cache;
  int jobs = default_jobs();
  bool retry = false;
  bool quiet = false;
};

/// A folder that is not there, is a tuning's, or holds nothing but what one that just began leaves.
bool holds_tuning_or_nothing(const fs::path& out) {
  std::error_code ignored;
  if (!fs::exists(out, ignored) || fs::exists(out / "tune.yaml", ignored)) return true;
  if (!fs::is_directory(out, ignored)) return false;
  for (const auto& entry : fs::directory_iterator(out, ignored)) {
    const fs::path name = entry.path().filename();
    if (name != ".lock" && name.extension() != ".tmp") return false;
  }
  return true;
}

/// Makes the folder and keeps others out. Error when it is something else or in use.
Result<FolderLock> claim(const fs::path& out, const TunePlan& plan) {
  std::error_code code;
  if (!holds_tuning_or_nothing(out)) {
    return failure(
        fmt::format("{}: exists and is no tuning's folder; give another --out", out.string()));
  }
  fs::create_directories(out, code);
  if (code) return failure(fmt::format("{}: {}", out.string(), code.message()));
  auto lock = FolderLock::take(out);
  if (!lock) {
    return failure(
        fmt::format("{}: another tuning works there, or it cannot be written", out.string()));
  }
  auto written = write_plan(plan, out / "tune.yaml");
  if (!written) return tl::unexpected(written.error());
  return std::move(*lock);
}

Result<void> check_apply(const TuneArguments& arguments, const TunePlan& plan) {
  if (arguments.apply.empty()) return {};
  if (plan.objectives.size() > 1) {
    return failure(
        "--apply: several objectives give a front, of which none is the best; expected "
        "a plan with one");
  }
  const fs::path folder = fs::absolute(arguments.apply).parent_path();
  if (fs::is_directory(folder)) return {};
  return failure(fmt::format("--apply {}: no folder {}", arguments.apply, folder.string()));
}

Result<TuneResult> work(const TuneArguments& arguments, std::uintmax_t cache_limit,
                        const TuneTask& task) {
  JobOptions options;
  options.folder = fs::path(arguments.out) / "jobs";
  if (!arguments.cache.folder.empty()) options.cache = arguments.cache.folder;
  options.cache_limit = cache_limit;
  options.jobs = arguments.jobs;
  options.timeout_s = task.plan.timeout;
  options.retry = arguments.retry;
  watch_interrupt();
  JobRunner runner(std::move(options));
  JobDisplay display(arguments.quiet);
  auto result = tune(task, run_by_jobs(runner, display.observer(), task.plan.objectives));
  display.close();
  print_pruned(runner.pruned(), arguments.cache);
  return result;
}

int finish(const TuneArguments& arguments, const TuneResult& result) {
  const fs::path out = arguments.out;
  std::vector<std::string> warnings;
  if (auto written = write_tuning(result, out, warnings); !written) {
    return bad_input("tune", written.error());
  }
  for (const std::string& warning : warnings) fmt::print("warning: {}\n", warning);
  if (!result.complete) fmt::print("interrupted: the same command continues\n");
  if (!result.chosen.empty()) {
    const bool front = result.tables.size() > 1;
    fmt::print("{}", to_text(front ? front_table(result) : outcome_table(result)));
  }
  fmt::print("results: {}\n", (out / "tune.md").string());
  if (!result.complete) return kInterrupted;
  if (arguments.apply.empty()) return kOk;
  if (auto written = write_overlay(result, arguments.apply); !written) {
    return bad_input("tune", written.error());
  }
  fmt::print("values: {0}; to use them: --set @{0}\n", arguments.apply);
  return kOk;
}

int tune_command(const TuneArguments& arguments, const fs::path& scenario_folder) {
  const auto plan = load_tune_plan(arguments.plan);
  if (!plan) return bad_input("tune", plan.error());
  if (auto right = check_apply(arguments, *plan); !right) return bad_input("tune", right.error());
  const auto limit = limit_of(arguments.cache);
  if (!limit) return bad_input("tune", limit.error());
  const auto task =
      tune_task(*plan, arguments.folder.empty() ? scenario_folder : fs::path(arguments.folder));
  if (!task) return bad_input("tune", Error{arguments.plan + ": " + task.error().message});
  const auto lock = claim(arguments.out, *plan);
  if (!lock) return bad_input("tune", lock.error());
  const auto result = work(arguments, *limit, *task);
  if (!result) return bad_input("tune", result.error());
  return finish(arguments, *result);
}

}  // namespace

void add_tune_command(CLI::App& app, const fs::path& scenario_folder, int& exit_code) {
  auto* command = app.add_subcommand(
      "tune", "Look for better values of an estimator's parameters; says whether they hold");
  auto arguments = std::make_shared<TuneArguments>();
  command->add_option("plan", arguments->plan, "YAML file: what is tuned, on what, for what")
      ->required();
  command->add_option("--folder", arguments->folder,
                      "Folder of scenarios, searched with those in it");
  command->add_option("--out", arguments->out, "Folder that is filled or continued (out/tune)");
  command->add_option(
      "--apply", arguments->apply,
      "Write the values there as a file for --set @FILE, with where they come from");
  add_cache_options(*command, arguments->cache);
  add_jobs_option(*command, arguments->jobs,
                  "Processes at a time; the results do not depend on it");
  command->add_flag("--retry", arguments->retry, "Do units that failed before again");
  command->add_flag("--quiet", arguments->quiet, "No progress");
  command->footer(
      "Examples:\n"
      "  aims tune bench/tuning/plans/aims.yaml --out out/tune --jobs 2\n"
      "  aims tune plan.yaml --apply tuned.yaml\n"
      "  aims run corridor --set @tuned.yaml\n"
      "What is done is kept: the same command continues, and repeats nothing. docs/tuning.md\n"
      "tells what to tune. Exit codes: as of aims.");
  command->callback([arguments, scenario_folder, &exit_code] {
    exit_code = tune_command(*arguments, scenario_folder);
  });
}

}  // namespace aims
