// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "bench/studies/detectors.hpp"
#include "core/error.hpp"

namespace aims {

/// Draws roc.png and roc.svg into `folder`: the pooled curves of every index, a panel per level.
Result<void> draw_detectors(const DetectorStudy& study, const std::filesystem::path& folder);

}  // namespace aims
