// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "bench/studies/consistency_study.hpp"
#include "core/error.hpp"

namespace aims {

/// Draws SCENARIO-ESTIMATOR-consistency.png and .svg of each case into `folder`: NEES, root mean
/// squares, and one run.
Result<void> draw_consistency(const ConsistencyStudy& study, const std::filesystem::path& folder);

}  // namespace aims
