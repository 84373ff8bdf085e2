// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "bench/run/run.hpp"
#include "bench/run/score_record.hpp"
#include "core/files/csv.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// One row per scan: everything in ScanDiagnostics and the time that the scan took [ms].
CsvTable diagnostics_table(const EstimatorOutcome& outcome);

/// One row per passed reference point.
CsvTable waypoint_times_table(const std::vector<WaypointTime>& waypoint_times);

/// One row per run, estimator and score: seed, estimator, score, value.
CsvTable scores_csv(std::span<const RunRecord> runs);

}  // namespace aims
