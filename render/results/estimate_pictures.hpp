// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "bench/estimate/estimate.hpp"
#include "bench/run/draw_observer.hpp"
#include "core/error.hpp"

namespace aims {

/// Draws the maps and the degeneracy index; with a truth also the trajectories.
Result<void> draw_estimate(const EstimateResult& result, const std::filesystem::path& folder,
                           const DrawObserver& observer = {});

}  // namespace aims
