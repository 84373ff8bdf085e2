// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bench/scoring/score_record.hpp"
#include "bench/scoring/timed_estimator.hpp"
#include "core/files/csv.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// One row per scan: stamp, the estimator's series by name, the stated covariance of the pose
/// (upper triangles, body axes) and the wall time that the scan took [ms]. What is not computed is
/// empty.
CsvTable diagnostics_table(const EstimatorRows& rows);

/// Appends the scans of rows of the same series to such a table.
void add_scans(const EstimatorRows& rows, CsvTable& table);

/// Reads a file of that table, but for the times; its series have no unit and no meaning. Of
/// columns other than the stamps only those in `only` are read, unless that is empty. Error without
/// the stamps.
Result<Diagnostics> read_diagnostics(const std::filesystem::path& file,
                                     std::vector<std::string> only = {});

/// One row per passed reference point.
CsvTable waypoint_times_table(const std::vector<WaypointTime>& waypoint_times);

/// One row per run, estimator and score: seed, estimator, score, value. An invalid run has one row,
/// of the score robot.valid and no estimator.
CsvTable scores_csv(std::span<const RunRecord> runs);

}  // namespace aims
