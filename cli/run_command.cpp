// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "bench/scoring/health_summary.hpp"
#include "bench/scoring/run_failure.hpp"
#include "bench/scoring/score_table.hpp"
#include "bench/studies/written_runs.hpp"
#include "cli/commands.hpp"
#include "cli/json_output.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/suite_options.hpp"
#include "cli/terminal.hpp"
#include "render/results/pictures.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct RunArguments {
  SharedOptions shared;
  bool no_pictures = false;
  bool no_page = false;
  bool json = false;
};

Result<SuiteOptions> options_of(const SharedOptions& given, const Scenario& scenario) {
  SharedOptions shared = given;
  if (shared.out.empty()) {
    const std::string text = shared.seeds.empty() ? std::to_string(scenario.seed) : shared.seeds;
    shared.out = (fs::path("out") / fmt::format("{}-seed-{}", scenario.name, text)).string();
  }
  auto options = suite_options(shared, {});
  if (!options) return options;
  options->jobs.retry = true;
  options->jobs.outputs.trajectories = true;
  return options;
}

std::string seeds_text(const SuiteCase& each) {
  std::vector<std::uint64_t> seeds;
  for (const RunRecord& run : each.runs) seeds.push_back(run.seed);
  return fmt::format("{}", fmt::join(seeds, ", "));
}

/// A line per seed and estimator that was not healthy all along.
void print_health(const SuiteCase& each) {
  for (const RunRecord& run : each.runs) {
    for (const std::string& line : health_lines(run)) print_out("health: {}\n", line);
  }
}

/// Draws the runs; a picture that cannot be drawn is a warning: the results are there.
void draw(const std::vector<fs::path>& folders, const SharedOptions& shared) {
  DrawDisplay display(shared.quiet);
  for (const fs::path& folder : folders) {
    if (!fs::exists(folder / "truth.tum")) continue;  // every estimator failed
    const auto drawn = draw_run(folder, display.observer(), shared.jobs);
    if (!drawn) print_out("warning: {}\n", drawn.error().message);
  }
}

void print_run(const Suite& suite, const fs::path& out, const SharedOptions& shared) {
  const SuiteCase& each = suite.cases.front();
  if (!each.runs.empty()) {
    print_out("{}, seed {}\n", each.scenario.name, seeds_text(each));
    const bool several_seeds = each.runs.front().seed != each.runs.back().seed;
    print_scores_table(score_table(each.runs), several_seeds ? "summary.md" : "scores.json");
    print_out("{}\n", score_legend(each.runs, each.scenario.scoring));
    for (const std::string& line : failure_lines(each.runs)) print_out("no success: {}\n", line);
    print_health(each);
    print_invalid_poses(each);
  }
  print_ring_notes(suite);
  print_expectations(suite);
  print_outcome(suite, shared);
  if (const auto warning = route_warning(each.scenario)) print_out("warning: {}\n", *warning);
  print_calibration_warnings(suite, shared);
  print_out("results: {}\n", (out / "").string());
  for (const fs::path& picture : pictures_in(out)) print_out("  {}\n", picture.string());
}

Result<Answer> run_command(const RunArguments& arguments) {
  const SharedOptions& shared = arguments.shared;
  const auto scenario = scenario_of(shared);
  if (!scenario) return tl::unexpected(scenario.error());
  const auto options = options_of(shared, *scenario);
  if (!options) return tl::unexpected(options.error());
  const auto first_seed =
      options->seeds.empty() ? static_cast<std::uint64_t>(scenario->seed) : options->seeds.front();
  if (auto ok = check_simulation(*scenario, first_seed); !ok) return tl::unexpected(ok.error());
  const auto suite = run_with_display({{scenario->file, *scenario}}, *options, shared.quiet);
  if (!suite) return tl::unexpected(suite.error());
  const SuiteCase& each = suite->cases.front();
  const fs::path& out = options->jobs.out;
  if (auto written = write_runs(*suite, out); !written) return tl::unexpected(written.error());
  if (!arguments.no_pictures) draw(run_folders(*suite, out), shared);
  print_run(*suite, out, shared);
  if (!arguments.no_page && !each.runs.empty()) write_pages_of(out, shared.quiet);
  return Answer{exit_code_with_expectations(*suite), run_json(*suite, out)};
}

}  // namespace

void declare_run(Command command, const fs::path& scenarios) {
  auto arguments = std::make_shared<RunArguments>();
  SharedOptions& shared = arguments->shared;
  shared.folder = scenarios.string();
  add_scenario(command, shared, Presence::kRequired);
  add_folder(command, shared);
  add_seeds(command, shared, "that of the scenario");
  add_robot_seed(command, shared);
  add_estimators(command, shared, "those of the scenario");
  add_calibration(command, shared);
  add_settings(command, shared);
  add_out(command, shared, "out/SCENARIO-seed-N");
  add_overwrite(command, shared);
  add_cache(command, shared);
  add_jobs(command, shared);
  add_quiet(command, shared);
  command.flag("--no-pictures", arguments->no_pictures, "Draw no pictures");
  command.flag("--no-page", arguments->no_page, "Write no HTML page");
  add_json(command, arguments->json);
  command.footer(
      "The same command again continues, and runs only what is missing or has changed.\n"
      "Examples:\n"
      "  aims run scenarios/paper/corridor.yaml\n"
      "  aims run corridor --seeds 1-5 --set lidar.range_max=30 --out out/short-range");
  command.action([arguments] {
    return answer("run", arguments->json, [&] { return run_command(*arguments); });
  });
}

}  // namespace aims
