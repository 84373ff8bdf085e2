// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/tuning/tune.hpp"
#include "bench/tuning/tune_summary.hpp"
#include "bench/tuning/tune_verdict.hpp"
#include "cli/commands.hpp"
#include "cli/json_output.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct TuneArguments {
  SharedOptions shared;
  std::string plan;
  std::string apply;
  bool json = false;
};

/// Claims the folder and writes the plan. Error when it is something else or in use.
Result<StoreClaim> claim(const fs::path& out, const TunePlan& plan) {
  auto claimed = claim_store(out);
  if (!claimed) return claimed;
  auto written = write_plan(plan, out / "tune.yaml");
  if (!written) return tl::unexpected(written.error());
  return claimed;
}

Result<TunePlan> plan_of(const TuneArguments& arguments) {
  auto plan = load_tune_plan(arguments.plan);
  if (!plan) return plan;
  put_on_top(arguments.shared, *plan);
  const auto estimators = joined_specs(arguments.shared.estimators);
  if (estimators.size() > 1) {
    return failure(
        fmt::format("--estimators: expected one estimator, found {}", estimators.size()));
  }
  if (!estimators.empty()) plan->estimator = estimators.front();
  if (arguments.apply.empty()) return plan;
  if (plan->objectives.size() > 1) {
    return failure("--apply: several objectives give a Pareto front; expected a plan with one");
  }
  const fs::path folder = fs::absolute(arguments.apply).parent_path();
  if (fs::is_directory(folder)) return plan;
  return failure(fmt::format("--apply {}: no folder {}", arguments.apply, folder.string()));
}

Result<TuneResult> work(const SharedOptions& shared, const TuneTask& task) {
  JobOptions options = job_options(shared);
  options.timeout_s = task.plan.timeout;
  watch_interrupt();
  JobRunner runner(std::move(options));
  JobDisplay display(shared.quiet);
  auto result = tune(
      task, run_by_jobs(runner, display.observer(), task.plan.objectives, expected_jobs(task)));
  display.close();
  print_pruned(runner.pruned(), shared);
  return result;
}

/// Prints where the values of --apply are and whether to use them.
void print_applied(const TuneResult& result, const std::string& file) {
  if (keeps_defaults(result)) {
    print_out("written: {}, without any value: the defaults are kept\n", file);
  } else if (verdict_of(held_out_gain(result)) == Verdict::kUseThem) {
    print_out("written: {0}; to use the values: --set @{0}\n", file);
  } else {
    print_out("written: {}; see the verdict before you use the values\n", file);
  }
}

/// The verdict, what the objective is, and the figures of both kinds of sequences.
void print_outcome(const TuneResult& result) {
  for (const std::string& line : verdict_lines(result)) print_out("{}\n", line);
  if (!result.earlier_looks.empty()) {
    print_out("warning: {}\n", looks_text(result.earlier_looks.size()));
  }
  if (defaults_all_diverged(result.tables.front())) {
    print_out("warning: on the sequences tuned on, {}\n", kNoGain);
  }
  const bool front = result.tables.size() > 1;
  print_out("{}", to_text(front ? front_table(result) : outcome_table(result)));
  for (const std::string& line : objective_lines(result)) print_out("{}\n", line);
  print_out("search: {}\n", search_text(result));
  for (const std::string& line : defaults_outside(result.task)) print_out("note: {}\n", line);
}

Result<Answer> finish(const TuneArguments& arguments, TuneResult& result) {
  const fs::path out = arguments.shared.out;
  if (auto noted = note_look(result, out); !noted) return tl::unexpected(noted.error());
  if (auto written = write_tuning(result, out); !written) return tl::unexpected(written.error());
  if (!result.complete) print_out("interrupted: the same command continues\n");
  if (!result.chosen.empty()) print_outcome(result);
  const auto left_out = left_out_lines(result);
  for (const std::string& line : left_out) print_out("INVALID RUNS: {}\n", line);
  const auto failed = failed_lines(result);
  for (const std::string& line : failed) print_out("FAILED RUNS: {}\n", line);
  print_out("results: {}\n", (out / "tune.md").string());
  write_pages_of(out, arguments.shared.quiet);
  Json document = tune_json(result);
  document["out"] = out.string();
  if (!result.complete) return Answer{interrupted_code(), std::move(document)};
  if (!arguments.apply.empty()) {
    if (auto written = write_overlay(result, arguments.apply); !written) {
      return tl::unexpected(written.error());
    }
    print_applied(result, arguments.apply);
  }
  const int code = !failed.empty() ? kExpectationFailed : left_out.empty() ? kOk : kInvalidRun;
  return Answer{code, std::move(document)};
}

Result<Answer> tune_command(const TuneArguments& arguments) {
  const auto plan = plan_of(arguments);
  if (!plan) return tl::unexpected(plan.error());
  const auto task = tune_task(*plan, arguments.shared.folder);
  if (!task) return failure(arguments.plan + ": " + task.error().message);
  const auto lock = claim(arguments.shared.out, *plan);
  if (!lock) return tl::unexpected(lock.error());
  auto result = work(arguments.shared, *task);
  if (!result) return tl::unexpected(result.error());
  return finish(arguments, *result);
}

}  // namespace

void declare_tune(Command command, const fs::path& scenarios) {
  auto arguments = std::make_shared<TuneArguments>();
  arguments->shared.folder = scenarios.string();
  command.argument("plan", arguments->plan,
                   "YAML file: parameters, sequences, objectives, optimizer");
  add_plan_options(command, arguments->shared,
                   "KEY=LOW:HIGH or\nKEY=log(LOW,HIGH), a key of the estimator");
  add_continued_out(command, arguments->shared, "out/tune");
  command.option("--apply", arguments->apply,
                 "Also write the tuned values to this file, for --set @FILE");
  add_json(command, arguments->json);
  command.footer(
      "The same command again continues.\n"
      "Examples:\n"
      "  aims tune bench/tuning/plans/aims.yaml --out out/tune --jobs 2\n"
      "  aims tune plan.yaml --apply tuned.yaml\n"
      "  aims run corridor --set @tuned.yaml");
  command.action([arguments] {
    return answer("tune", arguments->json, [&] { return tune_command(*arguments); });
  });
}

}  // namespace aims
