// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/jobs/sweep_store.hpp"
#include "bench/tuning/objective.hpp"
#include "core/error.hpp"

namespace aims {

/// What the plans of a sweep vary, each key once, and what they set of the estimators besides.
struct VariedParameters {
  std::vector<ParameterRange> ranges;
  EstimatorConfig base;  ///< without what is varied
  /// What scenarios have themselves of varied keys that are not the estimator's; that of the first
  /// one where they differ.
  std::map<std::string, double> scenario_values;
};

/// Error when no plan varies anything or a plan cannot be read.
Result<VariedParameters> varied_in(const MergedSweep& sweep);

/// Where a unit stands in a design.
struct PlacedJob {
  EstimatorSpec estimator;     ///< with the settings that are not varied
  std::vector<double> values;  ///< of each range; empty: the untuned estimator
  ResponseCase on;
  JobResult result;
};

/// None for a unit that has no file, or values of some ranges alone.
std::optional<PlacedJob> placed_job(const MergedJob& unit, const VariedParameters& varied);

/// The untuned value of each range for that estimator. Error for a setting or key that is unknown.
Result<std::vector<double>> untuned_values(const EstimatorSpec& estimator,
                                           const VariedParameters& varied);

/// The points of one estimator of a sweep, in one score.
struct SweepResponse {
  std::string estimator;  ///< with the settings that are not varied
  ResponseTable table;
  std::size_t incomplete = 0;  ///< points left out since not all of their walks are done
};

/// The units of a sweep as tables, one per estimator: the ranges are those of the plans, a point
/// counts once all its walks are done. Without runs of the untuned estimator the tables have no
/// `default_runs`. Error when no plan varies anything or a plan cannot be read.
Result<std::vector<SweepResponse>> sweep_responses(const MergedSweep& sweep,
                                                   const std::string& score);

/// Writes sweep.md with the best points, what matters, and pictures beside it (in a folder per
/// estimator where there are several), so far as units are done. Where untuned runs are missing, a
/// relative objective becomes one of plain scores. What cannot be drawn is named in `warnings`.
Result<void> write_sweep_report(const MergedSweep& sweep, Objective objective,
                                const std::filesystem::path& folder,
                                std::vector<std::string>& warnings);

}  // namespace aims
