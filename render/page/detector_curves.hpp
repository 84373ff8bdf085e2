// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "bench/run/score_record.hpp"
#include "core/error.hpp"
#include "render/page/page_data.hpp"

namespace aims {

/// Results of a detector study for a page: detectors.json with each score's curve
/// as an array of the page (false-alarm rate and detection rate, alternating). Pooled curves
/// keep at most 400 points, those of one scenario 60, evenly chosen with both ends. Error when the
/// file is no detectors.json.
Result<Json> detector_curves(const std::filesystem::path& file, PageData& page);

}  // namespace aims
