// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "bench/run/draw_observer.hpp"
#include "bench/studies/families.hpp"
#include "core/error.hpp"

namespace aims {

/// Draws each family's scores over its levels into `folder`: NAME.png and NAME.svg, and of the
/// severity levels also over the equivalent returns along the weak axis.
Result<void> draw_families(const std::vector<FamilyResult>& families,
                           const std::filesystem::path& folder, const DrawObserver& observer = {});

}  // namespace aims
