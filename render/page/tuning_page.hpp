// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "render/page/page_data.hpp"
#include "render/page/tuning_source.hpp"

namespace aims {

/// The page of the folder of `aims sweep` or `aims tune`, finished or not: every job with its
/// parameters and scores, and per estimator and score the best values of `aims merge`,
/// of which parameter matters, and of the curves and maps. Error when the folder is of neither.
Result<PageData> tuning_page(const std::filesystem::path& folder, const PageOptions& options);

/// The same of a source that was read; `folder`: where a tuning wrote what it came to.
Result<PageData> tuning_page(const TuningSource& source, const std::filesystem::path& folder);

}  // namespace aims
