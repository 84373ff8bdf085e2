// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bench/studies/calibration_runs.hpp"
#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/table.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct CalibrateArguments {
  SharedOptions shared;
  std::vector<std::string> sources;
  std::vector<std::string> topics;
  std::string config;
};

/// A scenario by its name or YAML file; all else is a recording.
bool is_scenario(const std::string& source) {
  const std::string extension = fs::path(source).extension().string();
  const bool yaml = extension == ".yaml" || extension == ".yml";
  return !fs::exists(source) || (yaml && !is_recorded_table(source));
}

/// Error for a recording that is named twice and for what is none.
Result<void> check_sources(const std::vector<std::string>& sources) {
  std::set<fs::path> seen;
  for (const std::string& each : sources) {
    if (each.find('=') != std::string::npos && !fs::exists(each)) {
      return failure(each +
                     ": no recording or scenario; --topics takes several with commas, "
                     "lidar=/a,imu=/b");
    }
    if (is_scenario(each) != is_scenario(sources.front())) {
      return failure(
          fmt::format("{} and {}: a recording and a scenario cannot be mixed; expected "
                      "recordings of one robot, or scenarios",
                      sources.front(), each));
    }
    std::error_code ignored;
    if (is_scenario(each) || seen.insert(fs::weakly_canonical(each, ignored)).second) continue;
    return failure(each + ": named twice, expected each recording once");
  }
  return {};
}

Result<std::vector<CalibrationRun>> runs_of_scenario(const CalibrateArguments& arguments,
                                                     const std::string& source) {
  SharedOptions shared = arguments.shared;
  shared.scenario = source;
  auto scenario = scenario_of(shared);
  if (!scenario) return tl::unexpected(scenario.error());
  const auto seeds = seeds_of(shared, {static_cast<std::uint64_t>(scenario->seed)});
  if (!seeds) return tl::unexpected(seeds.error());
  std::vector<CalibrationRun> runs;
  for (const std::uint64_t seed : *seeds) {
    if (!shared.quiet) print_error(fmt::format("{} seed {}", scenario->name, seed));
    auto run = calibration_run(*scenario, seed, shared.cache, [](double) {});
    if (!run) return tl::unexpected(run.error());
    runs.push_back(std::move(*run));
  }
  return runs;
}

Result<CalibrationRun> run_of_recording(const CalibrateArguments& arguments,
                                        const std::string& source) {
  const auto overrides = overrides_of(arguments.shared, arguments.topics);
  if (!overrides) return tl::unexpected(overrides.error());
  const auto config = load_estimate_config(arguments.config, *overrides);
  if (!config) return tl::unexpected(config.error());
  EstimateOptions options;
  options.bag = source;
  options.jobs = arguments.shared.jobs;
  ProgressDisplay display(source, arguments.shared.quiet, "read");
  auto run = calibration_run(*config, options, [&](const Progress& progress) {
    return display.show(std::nullopt, progress);
  });
  display.close();
  return run;
}

/// Error where sequences are simulated with a robot drawn for each of them.
Result<void> check_robot_seed(const CalibrateArguments& arguments) {
  std::size_t drawn = 0;
  for (const std::string& source : arguments.sources) {
    if (!is_scenario(source)) continue;
    SharedOptions shared = arguments.shared;
    shared.scenario = source;
    const auto scenario = scenario_of(shared);
    if (!scenario) return tl::unexpected(scenario.error());
    const auto seeds = seeds_of(shared, {static_cast<std::uint64_t>(scenario->seed)});
    if (!seeds) return tl::unexpected(seeds.error());
    if (scenario->simulation.robot_seed == 0) drawn += seeds->size();
  }
  if (drawn < 2) return {};
  return failure(
      fmt::format("{} sequences have a robot drawn for each: expected --robot-seed N, "
                  "the one robot of all",
                  drawn));
}

Result<std::vector<CalibrationRun>> runs_of(const CalibrateArguments& arguments) {
  std::vector<CalibrationRun> runs;
  for (const std::string& source : arguments.sources) {
    if (auto one = check_one_robot(runs); !one) return tl::unexpected(one.error());
    if (!is_scenario(source)) {
      auto run = run_of_recording(arguments, source);
      if (!run) return tl::unexpected(run.error());
      runs.push_back(std::move(*run));
      continue;
    }
    auto found = runs_of_scenario(arguments, source);
    if (!found) return tl::unexpected(found.error());
    std::move(found->begin(), found->end(), std::back_inserter(runs));
  }
  if (auto one = check_one_robot(runs); !one) return tl::unexpected(one.error());
  return runs;
}

/// Twice: how the filter weighs feet depends on what it knows of them, and the scale of the legs
/// on their compliance, which all recordings must have in common.
Result<std::vector<CalibrationRun>> runs_of_known_robot(CalibrateArguments arguments) {
  auto runs = runs_of(arguments);
  if (!runs || interrupted()) return runs;
  std::vector<std::string>& settings = arguments.shared.settings;
  const auto found = prior_settings(combined(*runs, ""), arguments.shared.out);
  settings.insert(settings.begin(), found.begin(), found.end());
  return runs_of(arguments);
}

void print_calibration(const RobotCalibration& calibration) {
  TextTable table{{"quantity", "entry", "value", "sigma", "without", "verdict", "used"}, {}};
  for (const CalibratedQuantity& each : calibration.quantities) {
    for (std::size_t i = 0; i < each.entries.size(); ++i) {
      table.rows.push_back({i == 0 ? each.name : "", each.entries[i],
                            fmt::format("{:.5f}", each.values[i]),
                            fmt::format("{:.5f}", each.sigma[i]),
                            fmt::format("{:.5f}", each.prior_sigma[i]), each.verdict[i],
                            i > 0       ? ""
                            : each.used ? "yes"
                                        : "no"});
    }
  }
  print_out("{}\n", to_text(table));
  for (const CalibratedQuantity& each : calibration.quantities) {
    if (!each.note.empty()) print_out("note: {}: {}\n", each.name, each.note);
  }
}

Result<int> calibrate(const CalibrateArguments& arguments) {
  const SharedOptions& shared = arguments.shared;
  if (fs::exists(shared.out) && !shared.overwrite) {
    return failure(shared.out + ": exists; give another --out, or --overwrite to replace it");
  }
  if (auto ok = check_sources(arguments.sources); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_robot_seed(arguments); !ok) return tl::unexpected(ok.error());
  watch_interrupt();
  CalibrateArguments measuring = arguments;
  std::vector<std::string>& settings = measuring.shared.settings;
  settings.insert(settings.begin(), "estimators.*.cross_validation.measure_legs=true");
  const auto runs = runs_of_known_robot(measuring);
  if (interrupted()) return interrupted_code();
  if (!runs) return tl::unexpected(runs.error());
  const std::string estimator = fmt::format("{}", fmt::join(shared.estimators, ","));
  const RobotCalibration calibration = combined(*runs, estimator);
  if (auto ok = write_file_atomically(shared.out, text_of(calibration)); !ok) {
    return tl::unexpected(ok.error());
  }
  print_calibration(calibration);
  for (const std::string& each : warnings_of(calibration, *runs)) print_out("warning: {}\n", each);
  print_out("calibration: {}\n", shared.out);
  return kOk;
}

}  // namespace

void declare_calibrate(Command command, const fs::path& scenarios) {
  auto arguments = std::make_shared<CalibrateArguments>();
  SharedOptions& shared = arguments->shared;
  shared.folder = scenarios.string();
  shared.estimators = {"aims_d"};
  command.arguments("source", arguments->sources,
                    "Recordings of one robot in places with features, or scenarios",
                    Presence::kRequired);
  command.option("-o,--out", shared.out, "Calibration to write, e.g. go2.calibration.yaml",
                 Presence::kRequired);
  command.option("--config", arguments->config,
                 "YAML file with the groups recording, estimator, scoring");
  command.list("--topics", arguments->topics, "SENSOR=TOPIC,..., as of aims estimate");
  add_folder(command, shared);
  add_seeds(command, shared, "that of the scenario");
  add_robot_seed(command, shared);
  add_settings(command, shared, "scenarios and recordings", kGroupSetting);
  add_cache(command, shared);
  add_jobs(command, shared);
  add_overwrite(command, shared);
  add_quiet(command, shared);
  command.footer(
      "aims run, suite and estimate start from it with --calibration FILE.\n"
      "Examples:\n"
      "  aims calibrate hall.bag yard.bag -o go2.calibration.yaml\n"
      "  aims calibrate garage --robot-seed 7 -o robot7.yaml\n"
      "  aims run severity_9 --robot-seed 7 --calibration robot7.yaml");
  command.action([arguments] {
    const auto code = calibrate(*arguments);
    return code ? *code : bad_input("calibrate", code.error());
  });
}

}  // namespace aims
