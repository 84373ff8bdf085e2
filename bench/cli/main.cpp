// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>

#include "bench/cli/commands.hpp"
#include "bench/cli/exit_code.hpp"
#include "bench/run/catalogue.hpp"

namespace {

constexpr const char* kDescription =
    "aims: legged-robot localization in degenerate corridors, settled by measurement.\n"
    "A simulated quadruped walks a scenario; every estimator gets the same measurements;\n"
    "truth scores them.";

constexpr const char* kFooter =
    "Examples:\n"
    "  aims run scenarios/paper/corridor.yaml\n"
    "  aims run corridor --seed 1-5 --estimators aims,lio --out out/compare\n"
    "  aims run corridor --set lidar.range_max=30 --set estimator.degeneracy.eta=5\n"
    "  aims suite --tags stress --seeds 1-5 --out out/stress\n"
    "  aims score --truth truth.tum --estimate mine.tum --segments a-b=12.5:110.2\n"
    "  aims report out/corridor-seed-1\n"
    "  aims compare out/before out/after\n"
    "  aims detectors corridor corridor_smooth --seeds 1-5\n"
    "  aims ablate severity_3 severity_8 --seeds 1-3\n"
    "  aims consistency severity_9 --seeds 1-50 --estimators aims_d,lio\n"
    "  aims sweep --over degeneracy.eta=0:6:13 --scenarios corridor --seeds 1-5\n"
    "  aims tune bench/tuning/plans/aims.yaml --out out/tune\n"
    "  aims render corridor --out out/render\n"
    "  aims simulate corridor -o walk.bag\n"
    "  aims estimate walk.bag --estimators aims,lio\n"
    "  aims info robot.bag\n"
    "  aims list\n"
    "  aims config corridor\n"
    "Exit codes: 0 ok, 1 an expectation of the scenario failed, 2 bad usage or configuration,\n"
    "3 internal error, 130 interrupted.";

int parse_and_run(int argc, char** argv) {
  CLI::App app(kDescription, "aims");
  app.footer(kFooter);
  app.set_version_flag("--version", "aims " AIMS_VERSION);
  app.require_subcommand(1);
  const std::filesystem::path scenarios =
      aims::default_scenario_folder(std::filesystem::read_symlink("/proc/self/exe"));
  int exit_code = aims::kOk;
  aims::add_run_command(app, scenarios, exit_code);
  aims::add_render_command(app, scenarios, exit_code);
  aims::add_simulate_command(app, scenarios, exit_code);
  aims::add_estimate_command(app, exit_code);
  aims::add_info_command(app, exit_code);
  aims::add_check_command(app, exit_code);
  aims::add_suite_command(app, scenarios, exit_code);
  aims::add_report_command(app, exit_code);
  aims::add_score_command(app, exit_code);
  aims::add_compare_command(app, exit_code);
  aims::add_detectors_command(app, scenarios, exit_code);
  aims::add_ablate_command(app, scenarios, exit_code);
  aims::add_consistency_command(app, scenarios, exit_code);
  aims::add_sweep_command(app, scenarios, exit_code);
  aims::add_merge_command(app, exit_code);
  aims::add_tune_command(app, scenarios, exit_code);
  aims::add_list_command(app, scenarios, exit_code);
  aims::add_config_command(app, scenarios, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? aims::kOk : aims::kBadInput;
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return parse_and_run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "aims: internal error: {}\n", error.what());
    return aims::kInternal;
  }
}
