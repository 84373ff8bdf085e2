// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "bench/run/evaluate.hpp"
#include "bench/run/score_record.hpp"
#include "core/files/csv.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// One row per scan: everything in ScanDiagnostics and the time that the scan took [ms].
CsvTable diagnostics_table(const EstimatorOutcome& outcome);

/// Reads a file of that table, but for the times.
Result<std::vector<ScanDiagnostics>> read_diagnostics(const std::filesystem::path& file);

/// One row per passed reference point.
CsvTable waypoint_times_table(const std::vector<WaypointTime>& waypoint_times);

/// One row per run, estimator and score: seed, estimator, score, value.
CsvTable scores_csv(std::span<const RunRecord> runs);

}  // namespace aims
