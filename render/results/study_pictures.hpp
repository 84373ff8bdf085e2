// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "bench/run/draw_observer.hpp"
#include "bench/studies/consistency_study.hpp"
#include "bench/studies/detectors.hpp"
#include "bench/studies/families.hpp"
#include "bench/studies/paper_study.hpp"
#include "core/error.hpp"

namespace aims {

/// Draws roc.png and roc.svg into `folder`: the pooled curves of every index, a panel per level.
Result<void> draw_detectors(const DetectorStudy& study, const std::filesystem::path& folder);

/// Draws SCENARIO-ESTIMATOR-consistency.png and .svg of each case into `folder`: NEES, root mean
/// squares, and one run.
Result<void> draw_consistency(const ConsistencyStudy& study, const std::filesystem::path& folder);

/// Draws each family's scores over its levels into `folder`: NAME.png and NAME.svg, and of the
/// severity levels also over the equivalent returns along the weak axis.
Result<void> draw_families(const std::vector<FamilyResult>& families,
                           const std::filesystem::path& folder, const DrawObserver& observer = {});

/// Draws each experiment's first seed, whose run lies in `folder` (bench/studies/written_runs.hpp),
/// as the paper's figures: SCENARIO-trajectories.png and SCENARIO-maps.png of LOAM, FAST-LIO2,
/// LeGO-LOAM and AIMS.
Result<void> draw_paper(const std::vector<PaperExperiment>& experiments,
                        const std::filesystem::path& folder, const DrawObserver& observer = {});

}  // namespace aims
