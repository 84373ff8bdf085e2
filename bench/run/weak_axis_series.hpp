// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "bench/metrics/consistency.hpp"
#include "bench/run/evaluate.hpp"
#include "core/error.hpp"
#include "core/files/csv.hpp"

namespace aims {

/// Spacing of the instants at which the series is kept [s].
inline constexpr int kSeriesSpacing = 1;

/// An estimator's error along the weak axis with its stated deviation and the bounds: a row for the
/// first scan in each second since the start of the run.
CsvTable weak_axis_table(const Sequence& sequence, const EstimatorOutcome& outcome);

/// Reads a file of that table.
Result<ConsistencyRun> read_weak_axis(const std::filesystem::path& file);

}  // namespace aims
