// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "bench/estimate/estimate.hpp"
#include "bench/scoring/score_record.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"

namespace aims {

/// A row per estimator: path length, speed, and its scores when there is a truth.
TextTable estimate_table(const EstimateResult& result);

/// The topics that were read, by their keys of `recording.topics`.
Json topics_json(const TopicsConfig& topics);

/// What estimate.json holds: schema aims.estimate/1, docs/result-files.md.
Json estimate_json(const EstimateResult& result);

/// What scores.json holds of an estimate that was scored: the record of a run, with its times.
RunRecord estimate_record(const EstimateResult& result);

/// Writes per estimator NAME.tum and NAME.diagnostics.csv, the config that repeats the estimate
/// (config.yaml) and estimate.json; with a truth also
/// truth.tum and, as a run has them, scores.json and scores.csv. What is in the folder of the
/// result since it ran, which then is `folder`, stays.
Result<void> write_estimate(const EstimateConfig& config, const EstimateResult& result,
                            const std::filesystem::path& folder);

}  // namespace aims
