// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/tuning/objective.hpp"
#include "core/error.hpp"

namespace aims {

/// Draws the objective into `folder`: KEY.png, a curve along each parameter, a line per family of
/// scenarios, and KEY-KEY.png, the map over the two with the largest total indices (the first two
/// without indices). Markers are measured points, a thin line is a fit; what has neither is left
/// out. points.png, every point over each parameter, unless they are a grid. The files, by
/// name.
Result<std::vector<std::string>> draw_response(const ResponseTable& table,
                                               const Objective& objective,
                                               const std::filesystem::path& folder);

}  // namespace aims
