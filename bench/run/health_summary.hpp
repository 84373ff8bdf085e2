// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/run/score_record.hpp"
#include "core/files/csv.hpp"
#include "estimator/health.hpp"

namespace aims {

/// How long an estimator called itself what, after its start.
struct HealthSummary {
  bool judged = false;  ///< false: the estimator does not judge itself
  HealthState worst = HealthState::kStarting;  ///< kStarting: it never started
  double healthy_s = 0.0;
  double degraded_s = 0.0;
  double invalid_s = 0.0;
  std::map<std::string, double> reasons;  ///< time [s] of each
};

/// Sums up rows, each of which holds until the next.
HealthSummary health_summary(const std::vector<HealthRow>& rows);

/// The summary with the keys of its members; see docs/result-files.md.
Json health_json(const HealthSummary& summary);

/// "degraded 3.2 s (no leg odometry 3.2 s)"; empty for an estimate that was healthy all along or
/// not judged.
std::string text_of(const HealthSummary& summary);

/// "lio seed 1: degraded (no leg odometry 3.2 s)" for each estimator of a run that was not
/// healthy all along; none for records without health, or not judged.
std::vector<std::string> health_lines(const RunRecord& run);

/// A row per health row: stamp_s, state, reasons, position_sigma_m.
CsvTable health_table(const std::vector<HealthRow>& rows);

}  // namespace aims
