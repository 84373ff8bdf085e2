// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/tuning/objective.hpp"
#include "bench/tuning/response_summary.hpp"
#include "bench/tuning/sweep_store.hpp"
#include "core/error.hpp"

namespace aims {

/// The ranges of a sweep's plans, each key once, and the settings of the estimators besides.
struct VariedParameters {
  std::vector<ParameterRange> ranges;
  EstimatorConfigs base;               ///< without the varied values
  std::vector<EstimatorSpec> planned;  ///< of the plans, with sorted settings
  /// What scenarios have themselves of varied keys that are not the estimator's; that of the first
  /// one where they differ.
  std::map<std::string, double> scenario_values;
};

/// Error when no plan varies anything or a plan cannot be read.
Result<VariedParameters> varied_in(const MergedSweep& sweep);

/// The point of a design that a job evaluates.
struct PlacedJob {
  EstimatorSpec estimator;     ///< as planned; else with the settings that are not varied
  std::vector<double> values;  ///< of each range; empty: the default setting
  ResponseCase on;
  JobResult result;
};

/// None for a job that has no file, or values of some ranges alone.
std::optional<PlacedJob> placed_job(const MergedJob& job, const VariedParameters& varied);

/// The default value of each range for that estimator. Error for a setting or key that is unknown.
Result<std::vector<double>> default_values(const EstimatorSpec& estimator,
                                           const VariedParameters& varied);

/// The points of one estimator of a sweep, in one score.
struct SweepResponse {
  std::string estimator;  ///< with the settings that are not varied
  ResponseTable table;
  std::size_t incomplete = 0;  ///< points left out since not all of their sequences are done
};

/// The jobs of a sweep as tables, one per estimator: the ranges are those of the plans, a point
/// counts once all its sequences are done. Without runs of the default setting the tables have no
/// `default_runs`. Error when no plan varies anything or a plan cannot be read.
Result<std::vector<SweepResponse>> sweep_responses(const MergedSweep& sweep,
                                                   const std::string& score);

/// A sentence on sequences of which no job is done, so that every point lacks them; empty: none.
std::string unstarted_text(const MergedSweep& sweep);

/// Writes sweep.md with the best points and sensitivity indices into `folder`, so far as jobs are
/// done. Where default runs are missing, a relative objective becomes one of plain scores.
Result<void> write_sweep_summary(const MergedSweep& sweep, const Objective& objective,
                                 const std::filesystem::path& folder);

}  // namespace aims
