// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "bench/scenario/scenario.hpp"
#include "bench/tuning/design.hpp"
#include "bench/tuning/objective.hpp"
#include "bench/tuning/optimizer.hpp"
#include "core/config.hpp"
#include "core/error.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {

/// Sequences for validation, which the optimizer does not use.
struct HeldOut {
  std::vector<std::string> scenarios;  ///< besides those that are tuned on
  std::vector<std::string> tags;       ///< with them, all scenarios with any of these tags
  std::string seeds;  ///< of these scenarios and of those tuned on; empty: these alone, tuned seeds
};

/// Parameters, sequences and objectives of a tuning.
struct TunePlan {
  std::string estimator = "aims";      ///< spec of the estimator at its default setting
  std::vector<std::string> params;     ///< ranges (bench/tuning/design.hpp); without counts
  std::vector<std::string> scenarios;  ///< files or names
  std::vector<std::string> tags;       ///< with them, all scenarios with any of these tags
  std::string seeds = "1-3";
  HeldOut held_out;
  std::vector<std::string> set;  ///< "key=value" on top of every scenario
  std::vector<Objective> objectives = {Objective{}};
  OptimizerOptions optimizer;
  double timeout = 0.0;  ///< wall time that a job is given [s]; 0: any
};

void describe(Fields& fields, HeldOut& held_out);
void describe(Fields& fields, OptimizerOptions& options);
void describe(Fields& fields, TunePlan& plan);

/// Reads a plan; errors name file, line, key and expectation.
Result<TunePlan> load_tune_plan(const std::filesystem::path& file);

/// The plan as YAML that loads again.
std::string plan_text(const TunePlan& plan);

/// Writes `plan_text` to a file, whole or not at all.
Result<void> write_plan(const TunePlan& plan, const std::filesystem::path& file);

/// A scenario's sequence on one seed.
struct ScenarioSeed {
  std::shared_ptr<const Scenario> scenario;
  std::uint64_t seed = 0;
};

/// "3 sequences: corridor, severity_5; seeds 1 2 3".
std::string sequences_text(std::span<const ScenarioSeed> sequences);

/// A plan with all that it names found and checked.
struct TuneTask {
  TunePlan plan;
  EstimatorSpec estimator;
  std::vector<ParameterRange> ranges;
  std::vector<double> defaults;  ///< default value per range
  std::vector<ScenarioSeed> sequences;
  std::vector<ScenarioSeed> held_out;
};

/// Error for a plan without ranges or sequences, for ranges, objectives or an optimizer that are
/// not right, for scenarios in which the default values differ, and for a sequence that is both
/// tuned on and held out. `scenario_folder` is where names and tags are looked up.
Result<TuneTask> tune_task(const TunePlan& plan, const std::filesystem::path& scenario_folder);

/// The ids of the jobs that a tuning asked for, in tune_jobs.csv of its folder: jobs of an earlier
/// plan may lie beside them. Error when it cannot be written.
Result<void> write_tune_jobs(const std::filesystem::path& folder, const std::set<std::string>& ids);

/// None where the folder has no such file.
std::optional<std::set<std::string>> read_tune_jobs(const std::filesystem::path& folder);

}  // namespace aims
