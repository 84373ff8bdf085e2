// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "bench/run/run.hpp"
#include "bench/run/score_record.hpp"
#include "core/error.hpp"
#include "core/time.hpp"

namespace aims {

/// Truth poses are written at this spacing; the simulation holds them at the physics rate.
inline constexpr Duration kTruthSpacing = 10 * kMillisecond;

/// Writes what one estimator came to: trajectory (NAME.tum), diagnostics (NAME.diagnostics.csv)
/// and, where it keeps one, its map (NAME.map.ply).
Result<void> write_estimator(const EstimatorOutcome& outcome, const std::filesystem::path& folder);

/// Writes what a run's scores were made from: the files of `write_results` but the scores.
Result<void> write_streams(const Scenario& scenario, const RunResult& result,
                           const std::filesystem::path& folder);

/// Writes a run into `folder`: scores.json, scores.csv, config.yaml, truth.tum, waypoint_times.csv,
/// localizability.csv, legs.csv and per estimator trajectory (TUM), diagnostics (CSV) and map
/// (PLY). The files are described in docs/results.md.
Result<void> write_results(const Scenario& scenario, const RunResult& result,
                           const RunRecord& record, const std::filesystem::path& folder);

}  // namespace aims
