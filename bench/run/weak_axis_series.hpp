// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bench/metrics/consistency.hpp"
#include "bench/run/run.hpp"
#include "bench/run/score_record.hpp"

namespace aims {

/// Spacing of the instants at which the series is kept [s].
inline constexpr int kSeriesSpacing = 1;

/// Adds to the record, as "weak_axis_series", each estimator's error along the weak axis with its
/// stated deviation and the bounds: the first scan in each second since the start of the run.
void add_weak_axis_series(const RunResult& result, RunRecord& record);

/// Whether the record has the series of that estimator.
bool holds_series(const RunRecord& record, const std::string& label);

/// The series of that estimator; empty when there is none.
ConsistencyRun series_of(const RunRecord& record, const std::string& label);

}  // namespace aims
