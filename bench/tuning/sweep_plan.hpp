// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bench/jobs/job.hpp"
#include "bench/tuning/design.hpp"
#include "bench/tuning/objective.hpp"
#include "core/config.hpp"
#include "core/error.hpp"

namespace aims {

/// What a sweep is to do: the default setting and every point of a design, on every sequence, with
/// every estimator.
struct SweepPlan {
  std::vector<std::string> scenarios;  ///< files or names
  std::vector<std::string> tags;       ///< with them, all scenarios with any of these tags
  std::string seeds = "1";             ///< "1-5", "1,4,7-9"
  std::vector<std::string> estimators = {"aims"};  ///< specs (estimator/estimator_spec.hpp)
  std::vector<std::string> params;                 ///< ranges (bench/tuning/design.hpp)
  std::vector<std::string> set;                    ///< "key=value" on top of every scenario
  DesignKind design = DesignKind::kGrid;
  int samples = 64;      ///< points of every design but a grid
  int design_seed = 1;   ///< of those points
  double timeout = 0.0;  ///< wall time that a job is given [s]; 0: any
};

void describe(Fields& fields, SweepPlan& plan);

/// Reads a plan; errors name file, line, key and expectation.
Result<SweepPlan> load_plan(const std::filesystem::path& file);

/// The plan as YAML that loads again.
std::string plan_text(const SweepPlan& plan);

/// The scenarios that are named or have a tag, in that order, each once, with the settings on top.
/// `folder` is where names and tags are looked up. Error when there is none, for one that is not
/// there or does not load, and for two of one name.
Result<std::vector<std::shared_ptr<const Scenario>>> plan_scenarios(
    std::span<const std::string> scenarios, std::span<const std::string> tags,
    std::span<const std::string> settings, const std::filesystem::path& folder);

/// Error where a key of the ranges has another default value in one of the scenarios, so that no
/// point has the defaults of all.
Result<void> check_same_defaults(std::span<const std::shared_ptr<const Scenario>> scenarios,
                                 std::span<const ParameterRange> ranges,
                                 std::span<const EstimatorSpec> estimators);

/// The plan's classes in Python, and what it sets of its estimators, on top of `configs`.
Result<void> set_estimators(const SweepPlan& plan, EstimatorConfigs& configs);

/// The plan's jobs: by scenario, varied values of the simulation, seed, estimator, point, so that
/// those on one sequence stand together; none twice (points of a whole number may round to one, and
/// one may be the default). Error for a range, estimator or scenario that is not right, a value
/// that a parameter does not allow, and a plan without any job.
Result<std::vector<Job>> plan_jobs(const SweepPlan& plan,
                                   const std::filesystem::path& scenario_folder);

/// An estimator's name and its settings that are not varied, in order.
std::string fixed_text(EstimatorSpec spec, std::span<const ParameterRange> ranges);

/// Writes what the results of a sweep were analysed by to `objective.yaml` of their folder.
Result<void> write_objective(const Objective& objective, const std::filesystem::path& folder);

/// What `write_objective` wrote there last; the default one where it did not. Error for a file that
/// cannot be read.
Result<Objective> objective_in(const std::filesystem::path& folder);

/// Paths in a plan are relative to the plan's file: scenario files become paths from the working
/// directory. What is no file there stays as it is: the name of a scenario, or a path of a plan
/// that was stored with its results.
void resolve_scenarios(const std::filesystem::path& plan, std::vector<std::string>& scenarios);

/// The same for "@FILE" among settings.
void resolve_settings(const std::filesystem::path& plan, std::vector<std::string>& settings);

}  // namespace aims
