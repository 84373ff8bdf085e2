// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "bench/jobs/job_runner.hpp"
#include "bench/tuning/objective.hpp"
#include "bench/tuning/tune_plan.hpp"
#include "core/error.hpp"

namespace aims {

/// The score per estimator, sequence and objective.
using SequenceScores = std::vector<std::vector<std::vector<RunScore>>>;

/// Runs estimators over sequences. No value when it was interrupted.
using RunOnSequences = std::function<Result<std::optional<SequenceScores>>(
    std::span<const EstimatorSpec> estimators, std::span<const ScenarioSeed> sequences)>;

/// Result of a tuning, with one table per objective.
struct TuneResult {
  TuneTask task;
  std::vector<ResponseTable>
      tables;                   ///< on the sequences that are tuned on; point 0 are the defaults
  std::vector<int> generation;  ///< of each point, 0 = the first population
  std::vector<std::size_t> chosen;      ///< the best point; of several objectives the front
  std::vector<ResponseTable> held_out;  ///< of the chosen points, in order; empty: nothing held out
  std::vector<std::string> earlier_looks;  ///< at held-out sequences in the same folder
  bool complete = true;                    ///< false when it was interrupted
  bool converged = false;                  ///< ended before its last generation
};

/// Runs the default setting, optimizes the parameters, and evaluates the result on the held-out
/// sequences. The same task gives the same points where its scores do not depend
/// on time. Error when the default setting has no objective on the sequences.
Result<TuneResult> tune(const TuneTask& task, const RunOnSequences& run);

/// Whether no point of the search is better than the defaults. Nothing is held out then.
bool keeps_defaults(const TuneResult& result);

/// A line per parameter whose default lies outside of its range.
std::vector<std::string> defaults_outside(const TuneTask& task);

/// Jobs of a tuning that does not converge early: the default setting, every generation, and what
/// is held out (of several objectives about a population of points).
std::size_t expected_jobs(const TuneTask& task);

/// Runs estimators as jobs, those that `runner` has not stored yet, and reads their scores; its
/// store lists them (`write_tune_jobs`). The observer is told of all batches as of one
/// work of `expected` jobs.
RunOnSequences run_by_jobs(JobRunner& runner, const JobObserver& observer,
                           const std::vector<Objective>& objectives, std::size_t expected);

/// The task's estimator with the values of a point.
EstimatorSpec estimator_at(const TuneTask& task, std::span<const double> point);

/// The settings "key=value" of a point, below `estimator.`.
std::vector<std::pair<std::string, std::string>> settings_of(const TuneTask& task,
                                                             std::span<const double> point);

/// A table without runs: the task's ranges and defaults, a case per sequence.
ResponseTable empty_table(const TuneTask& task, std::span<const ScenarioSeed> sequences);

}  // namespace aims
