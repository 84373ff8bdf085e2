// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/scoring/health_time.hpp"
#include "bench/scoring/score_record.hpp"
#include "core/files/csv.hpp"
#include "estimator/interface/health.hpp"

namespace aims {

/// The summary with the keys of its members; see docs/result-files.md.
Json health_json(const HealthSummary& summary);

/// "degraded for 3.2 s (no leg odometry 3.2 s)"; of too short a recording that; empty for an
/// estimate that was healthy all along or not judged.
std::string text_of(const HealthSummary& summary);

/// Least time that an estimate is healthy while its error exceeds the limit of a success, for it to
/// be said [s].
inline constexpr double kLeastUnnoticed = 1.0;

/// "lio seed 1: degraded for 3.2 s (no leg odometry 3.2 s); healthy for 90.1 s while wrong" for
/// each estimator of a run that was not healthy all along, or was so while wrong; none for records
/// without health, or not judged.
std::vector<std::string> health_lines(const RunRecord& run);

/// A row per health row: stamp_s, state, reasons, position_sigma_m.
CsvTable health_table(std::span<const HealthRow> rows);

/// Appends rows to such a table.
void add_health_rows(std::span<const HealthRow> rows, CsvTable& table);

}  // namespace aims
