// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/scoring/score_record.hpp"
#include "bench/tuning/held_out.hpp"
#include "bench/tuning/objective.hpp"
#include "render/page/page_data.hpp"

namespace aims {

/// Results of `aims merge` and `aims tune` for one estimator and one objective, as a page holds
/// them: best point with its intervals, sensitivity, the curve along every parameter over all
/// scenarios and of every family, and the map over every pair of parameters. Parts that the points
/// do not yield are null and give the reason. Curves and maps are arrays of `page`.
Json analysis_json(const ResponseTable& table, const Objective& objective, PageData& page);

/// What the held-out sequences say of a point.
Json held_out_json(const PairedGain& gain);

}  // namespace aims
