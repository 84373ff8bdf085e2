// SPDX-License-Identifier: BSD-3-Clause
#include "cli/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "bench/run/estimator_fit.hpp"
#include "bench/scenario/seeds.hpp"
#include "cli/terminal.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {

namespace fs = std::filesystem;

int default_jobs() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

void add_scenario(Command& command, SharedOptions& options, Presence presence) {
  command.argument("scenario", options.scenario, "Scenario: a YAML file or a name of `aims list`",
                   presence);
}

void add_named_scenarios(Command& command, SharedOptions& options) {
  command.arguments("scenario", options.named, "The same as --scenarios");
}

void add_folder(Command& command, SharedOptions& options) {
  command.option("--folder", options.folder,
                 "Folder of scenarios, searched with its subfolders\n(the shipped ones)");
}

void add_tags(Command& command, SharedOptions& options) {
  command.list("--tags", options.tags, "Scenarios with any of these tags, e.g. stress,severity");
}

void add_scenarios(Command& command, SharedOptions& options) {
  command.list("--scenarios", options.scenarios, "Scenario files or names, e.g. corridor,garage");
  add_tags(command, options);
  add_folder(command, options);
}

void add_seeds(Command& command, SharedOptions& options, const std::string& absent) {
  command.option("--seeds,--seed", options.seeds,
                 fmt::format("Seed, range or list: 3, 1-5 or 1,4,7-9 ({})", absent));
}

void add_robot_seed(Command& command, SharedOptions& options) {
  command.option("--robot-seed", options.robot_seed, {0, 2147483647},
                 "Seed of the robot and its constant errors, which then\n"
                 "stay over seeds and scenarios; 0: the seed of the run");
}

void add_calibration(Command& command, SharedOptions& options) {
  command.option("--calibration", options.calibration,
                 "Calibration of the robot, a file of `aims calibrate`:\n"
                 "a prior that the data can overrule (none)");
}

void add_estimators(Command& command, SharedOptions& options, const std::string& absent) {
  command.list(
      "--estimators", options.estimators,
      fmt::format("Estimators, each NAME or LABEL=NAME+key=value with\n"
                  "keys below estimators.NAME, or\nLABEL=python:module.Class+key=value ({})",
                  absent));
}

void add_settings(Command& command, SharedOptions& options, const std::string& on,
                  const char* kind) {
  command.settings("--set", options.settings, kind,
                   fmt::format("A setting, or @FILE of settings, on top of\n{}", on));
}

void add_param(Command& command, SharedOptions& options, const std::string& forms) {
  command.repeatable("--param", options.param, fmt::format("Parameter to vary, {}", forms));
}

void add_out(Command& command, SharedOptions& options, const std::string& absent) {
  command.option("-o,--out", options.out, fmt::format("Where the results go ({})", absent));
}

void add_continued_out(Command& command, SharedOptions& options, const std::string& folder) {
  options.out = folder;
  command.option("-o,--out", options.out,
                 fmt::format("Folder of results; one that exists is continued\n({})", folder));
}

void add_cache(Command& command, SharedOptions& options) {
  constexpr double kMost = 1e9;
  command.option("--cache", options.cache,
                 "Folder of simulated sequences, shared by all commands\n"
                 "(~/.cache/aims/sequences)");
  command.option("--cache-limit", options.cache_limit_gb, {0.0, kMost},
                 "Size of the cache [GB]; those used longest ago are\n"
                 "removed, none that is in use; 0: no limit (20)");
}

void add_jobs(Command& command, SharedOptions& options) {
  command.option("-j,--jobs", options.jobs, {1, 256},
                 "Jobs at a time; the results do not depend on it\n(number of cores)");
}

void add_retry(Command& command, SharedOptions& options) {
  command.flag("--retry", options.retry, "Repeat jobs that failed before");
}

void add_overwrite(Command& command, SharedOptions& options) {
  command.flag("--overwrite", options.overwrite, "Replace results that exist");
}

void add_compression(Command& command, std::string& compression) {
  command.choice("--compression", compression, {"none", "lz4", "bz2", "zstd"},
                 "Of the chunks: bz2 in .bag, zstd in .mcap, none in rosbag2 (none)");
}

void add_quiet(Command& command, SharedOptions& options) {
  command.flag("-q,--quiet", options.quiet, "Show no progress");
}

std::vector<std::string> overrides_of(const SharedOptions& options) {
  std::vector<std::string> overrides = options.settings;
  if (options.robot_seed > 0) {
    overrides.push_back(fmt::format("robot_seed={}", options.robot_seed));
  }
  if (!options.estimators.empty()) {
    overrides.push_back(run_setting(joined_specs(options.estimators)));
  }
  return overrides;
}

namespace {

/// `overrides_of` on top of what the calibration sets. Error for an estimator of the command line
/// that there is not: as a key `run` it would be blamed on the scenario's file.
Result<std::vector<std::string>> calibrated_overrides_of(const SharedOptions& options) {
  if (auto specs = check_estimator_specs(joined_specs(options.estimators)); !specs) {
    return failure("--estimators: " + specs.error().message);
  }
  std::vector<std::string> overrides;
  if (!options.calibration.empty()) {
    const auto calibration = read_robot_calibration(options.calibration);
    if (!calibration) return failure("--calibration " + calibration.error().message);
    overrides = prior_settings(*calibration, options.calibration);
  }
  const auto given = overrides_of(options);
  overrides.insert(overrides.end(), given.begin(), given.end());
  return overrides;
}

}  // namespace

Result<std::vector<std::string>> overrides_of(const SharedOptions& options,
                                              const std::vector<std::string>& topics) {
  std::vector<std::string> overrides;
  for (const std::string& topic : topics) {
    if (topic.find('=') == std::string::npos) {
      return failure(
          fmt::format("--topics: expected SENSOR=TOPIC, e.g. lidar=/points, got '{}'", topic));
    }
    overrides.push_back("recording.topics." + topic);
  }
  const auto shared = calibrated_overrides_of(options);
  if (!shared) return shared;
  overrides.insert(overrides.end(), shared->begin(), shared->end());
  return overrides;
}

Result<void> check_settings(const std::vector<std::string>& settings,
                            const std::vector<std::string>& groups, bool refused) {
  for (const std::string& setting : settings) {
    if (setting.starts_with('@')) continue;  // a file may hold keys of every command
    const std::string key = setting.substr(0, setting.find('='));
    const bool in_group = std::any_of(groups.begin(), groups.end(), [&](const std::string& group) {
      return key == group || key.starts_with(group + ".");
    });
    if (in_group == refused) {
      return failure(fmt::format("--set {}: no effect in this command; it reads {} {}", setting,
                                 refused ? "every key but those of" : "only the keys of",
                                 fmt::join(groups, ", ")));
    }
  }
  return {};
}

Result<Scenario> scenario_of(const SharedOptions& options) {
  const auto file = named_scenario(options.scenario, options.folder);
  if (!file) return tl::unexpected(file.error());
  const auto overrides = calibrated_overrides_of(options);
  if (!overrides) return tl::unexpected(overrides.error());
  return load_scenario(*file, *overrides, options.folder);
}

Result<std::vector<ScenarioFile>> scenarios_of(const SharedOptions& options) {
  std::vector<std::string> names = options.named;
  names.insert(names.end(), options.scenarios.begin(), options.scenarios.end());
  const auto overrides = calibrated_overrides_of(options);
  if (!overrides) return tl::unexpected(overrides.error());
  return select_scenarios(names, options.tags, options.folder, *overrides);
}

Result<std::vector<std::uint64_t>> seeds_of(const SharedOptions& options,
                                            const std::vector<std::uint64_t>& absent) {
  return options.seeds.empty() ? absent : parse_seeds(options.seeds);
}

Result<std::uint64_t> seed_of(const SharedOptions& options, const Scenario& scenario) {
  const auto seeds = seeds_of(options, {static_cast<std::uint64_t>(scenario.seed)});
  if (!seeds) return tl::unexpected(seeds.error());
  if (seeds->size() == 1) return seeds->front();
  return failure(fmt::format("--seeds {}: expected one seed, since the output is of one sequence",
                             options.seeds));
}

JobOptions job_options(const SharedOptions& options) {
  JobOptions jobs;
  jobs.out = options.out;
  jobs.cache = options.cache;
  jobs.cache_limit = 0;
  if (options.cache_limit_gb > 0.0) {
    jobs.cache_limit = static_cast<std::uintmax_t>(std::max(1.0, 1e9 * options.cache_limit_gb));
  }
  jobs.jobs = options.jobs;
  jobs.retry = options.retry;
  return jobs;
}

void print_pruned(const CachePruned& pruned, const SharedOptions& options) {
  const fs::path folder =
      options.cache.empty() ? SequenceCache::default_folder() : fs::path(options.cache);
  const double limit_gb = options.cache_limit_gb;
  if (pruned.sequences > 0) {
    print_out("{}: removed {} sequences, {:.3g} GB (--cache-limit {})\n", folder.string(),
              pruned.sequences, 1e-9 * static_cast<double>(pruned.bytes), limit_gb);
  }
  const double left_gb = 1e-9 * static_cast<double>(pruned.left);
  if (limit_gb == 0.0 || left_gb <= limit_gb) return;
  print_out("{}: {:.3g} GB of sequences are in use, more than --cache-limit {}\n", folder.string(),
            left_gb, limit_gb);
}

std::vector<std::filesystem::path> further(const std::vector<std::string>& files) {
  return {files.begin() + 1, files.end()};
}

int bad_input(const char* command, const Error& error) {
  print_failure(fmt::format("aims {}: {}", command, error.message));
  return kBadInput;
}

void add_plan_options(Command& command, SharedOptions& options, const std::string& param_forms) {
  add_scenarios(command, options);
  add_seeds(command, options, "those of the plan");
  add_estimators(command, options, "those of the plan");
  add_param(command, options, param_forms);
  add_settings(command, options, "each scenario");
  add_cache(command, options);
  add_jobs(command, options);
  add_retry(command, options);
  add_quiet(command, options);
}

}  // namespace aims
