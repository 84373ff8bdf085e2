// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/jobs/job_runner.hpp"
#include "bench/scenario/catalogue.hpp"
#include "cli/command.hpp"
#include "core/error.hpp"

namespace aims {

/// As many as there are cores.
int default_jobs();

/// The options that several commands share. Each has one function below, so that it has the same
/// names, values and meaning in every command; a command declares those that it uses.
struct SharedOptions {
  std::string folder;  ///< of scenarios
  std::string scenario;
  std::vector<std::string> named;      ///< scenarios without a flag
  std::vector<std::string> scenarios;  ///< after --scenarios
  std::vector<std::string> tags;
  std::string seeds;
  std::vector<std::string> estimators;  ///< pieces of specs, as split at commas
  std::vector<std::string> settings;    ///< "key=value"
  std::vector<std::string> param;       ///< ranges
  std::string out;
  int robot_seed = 0;                         ///< 0: that of the scenario
  std::string calibration;                    ///< file of `aims calibrate`; empty: none
  std::string cache;                          ///< empty: the default
  double cache_limit_gb = kCacheLimit / 1e9;  ///< 0: any
  int jobs = default_jobs();
  bool retry = false;
  bool overwrite = false;
  bool quiet = false;
};

/// SCENARIO: one file or name.
void add_scenario(Command& command, SharedOptions& options, Presence presence);
/// --scenarios, --tags and --folder.
void add_scenarios(Command& command, SharedOptions& options);
/// [SCENARIO]...: the same as --scenarios without the flag.
void add_named_scenarios(Command& command, SharedOptions& options);
/// --folder alone.
void add_folder(Command& command, SharedOptions& options);
void add_tags(Command& command, SharedOptions& options);
/// --seeds; `absent` says what runs without it.
void add_seeds(Command& command, SharedOptions& options, const std::string& absent);
/// --robot-seed, where scenarios are simulated.
void add_robot_seed(Command& command, SharedOptions& options);
/// --calibration.
void add_calibration(Command& command, SharedOptions& options);
/// --estimators; likewise.
void add_estimators(Command& command, SharedOptions& options, const std::string& absent);
/// --set.
/// `kind`: kGroupSetting where the keys are not those of a scenario.
void add_settings(Command& command, SharedOptions& options, const std::string& on = "the scenario",
                  const char* kind = kScenarioSetting);
/// --param.
void add_param(Command& command, SharedOptions& options, const std::string& forms);
/// --out; `absent` names the folder without it.
void add_out(Command& command, SharedOptions& options, const std::string& absent);
/// --out of a command that continues what it finds in its folder.
void add_continued_out(Command& command, SharedOptions& options, const std::string& folder);
/// --cache and --cache-limit.
void add_cache(Command& command, SharedOptions& options);
/// --jobs.
void add_jobs(Command& command, SharedOptions& options);
/// --retry.
void add_retry(Command& command, SharedOptions& options);
/// --overwrite.
void add_overwrite(Command& command, SharedOptions& options);
/// --compression of a recording that is written.
void add_compression(Command& command, std::string& compression);
/// --quiet.
void add_quiet(Command& command, SharedOptions& options);

/// "key=value" of --set, with the estimators as the last.
std::vector<std::string> overrides_of(const SharedOptions& options);

/// The same for a recording, with its topics "SENSOR=TOPIC". Error for one of another form.
Result<std::vector<std::string>> overrides_of(const SharedOptions& options,
                                              const std::vector<std::string>& topics);

/// Error for a "key=value" of --set that does not begin with one of `groups`, or that begins with
/// one of them when they are `refused`: nothing in this command reads it.
Result<void> check_settings(const std::vector<std::string>& settings,
                            const std::vector<std::string>& groups, bool refused);

/// The scenario of SCENARIO with --set and --estimators on top.
Result<Scenario> scenario_of(const SharedOptions& options);

/// The scenarios that were given, with --set and --estimators on top. Error when there is none.
Result<std::vector<ScenarioFile>> scenarios_of(const SharedOptions& options);

/// The seeds of --seeds; `absent` without it.
Result<std::vector<std::uint64_t>> seeds_of(const SharedOptions& options,
                                            const std::vector<std::uint64_t>& absent);

/// The one seed of --seeds; the scenario's own without it. Error for several.
Result<std::uint64_t> seed_of(const SharedOptions& options, const Scenario& scenario);

/// Folder, cache, number of jobs and --retry.
JobOptions job_options(const SharedOptions& options);

/// Prints what was removed from the cache, and when more is in use than it may hold; else nothing.
void print_pruned(const CachePruned& pruned, const SharedOptions& options);

/// All files but the first, which names the recording.
std::vector<std::filesystem::path> further(const std::vector<std::string>& files);

/// Prints on standard error what was wrong with what `command` was given; the exit code for it.
int bad_input(const char* command, const Error& error);

/// What `aims sweep` and `aims tune` have in common: scenarios, seeds, estimators, --param, --set,
/// cache, --jobs, --retry and --quiet. Each is also a key of their plans.
void add_plan_options(Command& command, SharedOptions& options, const std::string& param_forms);

/// What was given replaces what the plan has, but --set, which comes on top of it.
template <class Plan>
void put_on_top(const SharedOptions& options, Plan& plan) {
  if (!options.scenarios.empty() || !options.tags.empty()) {
    plan.scenarios = options.scenarios;
    plan.tags = options.tags;
  }
  if (!options.param.empty()) plan.params = options.param;
  if (!options.seeds.empty()) plan.seeds = options.seeds;
  plan.set.insert(plan.set.end(), options.settings.begin(), options.settings.end());
}

}  // namespace aims
