// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/error.hpp"
#include "render/page/page_data.hpp"
#include "render/page/run_folder.hpp"
#include "sim/environment/scene.hpp"

namespace aims {

/// The scans of scans.csv: stamps "t", where each begins in the list of all points ("first"), how
/// many returns it had ("returns") and how many points stand below the ceiling ("below": the first
/// so many of its points); of all points the place "p" in the body frame at the scan's end, in
/// steps of `kMapStep`, and the "intensity" as a byte. Null without the file. `scene`: null when it
/// is not known; `roofed`: whether there may be a ceiling.
Result<PageData::Json> scans_json(const RunFolder& run, const Scene* scene, bool roofed,
                                  double start, PageData& page);

}  // namespace aims
