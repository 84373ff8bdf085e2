// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "bench/run/draw_observer.hpp"
#include "bench/studies/paper_study.hpp"
#include "core/error.hpp"

namespace aims {

/// Draws each experiment's first seed, whose run lies in `folder` (bench/studies/written_runs.hpp),
/// as the paper's figures: SCENARIO-trajectories.png and SCENARIO-maps.png of LOAM, FAST-LIO2,
/// LeGO-LOAM and AIMS.
Result<void> draw_paper(const std::vector<PaperExperiment>& experiments,
                        const std::filesystem::path& folder, const DrawObserver& observer = {});

}  // namespace aims
