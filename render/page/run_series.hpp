// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/error.hpp"
#include "render/page/page_data.hpp"
#include "render/page/run_folder.hpp"
#include "sim/environment/scene.hpp"

namespace aims {

/// Stamp [s] that a run's page counts from: 0 for a clock that starts with the run; for one that
/// counts from an epoch the truth's first pose, else the first of the estimates', since 32 bits
/// could not separate scans.
double page_start(const RunFolder& run);

/// Truth at about 10 Hz: t, p, q (x y z w); null when there is none.
Json truth_json(const RunFolder& run, double start, PageData& page);

/// The reference points with stamp and true place.
Json waypoint_times_json(const RunFolder& run, double start);

/// localizability.csv, with the degenerate intervals at each level; null without it.
Result<Json> localizability_json(const RunFolder& run, double start, PageData& page);

/// legs.csv; null without it.
Result<Json> legs_json(const RunFolder& run, double start, PageData& page);

/// The scans of scans.csv: stamps "t", where each begins in the list of all points ("first"), how
/// many returns it had ("returns") and how many points stand below the ceiling ("below": the first
/// so many of its points); of all points the place "p" in the body frame at the scan's end, in
/// steps of `kMapStep`, and the "intensity" as a byte. Null without the file. `scene`: null when it
/// is not known; `roofed`: whether there may be a ceiling.
Result<Json> scans_json(const RunFolder& run, const Scene* scene, bool roofed, double start,
                        PageData& page);

/// Trajectory, diagnostics and errors of an estimator over the stamps of its poses. Errors and
/// deviations are along the true body's heading, to its left and up; a column that has no value at
/// all is null.
Result<Json> series_json(const EstimatorFiles& estimator, const RunFolder& run, double start,
                         PageData& page);

}  // namespace aims
