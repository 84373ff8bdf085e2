// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "core/error.hpp"
#include "render/page/page_data.hpp"
#include "render/page/tuning_source.hpp"

namespace aims {

/// The page of one run, estimate or score: kind "run". The same folder gives the
/// same page, wherever it lies. Errors as of `read_run_folder`.
Result<PageData> run_page(const std::filesystem::path& folder);

/// Folders "seed-N" inside a folder of `aims run` that each hold a run, by seed.
std::vector<std::filesystem::path> seed_folders(const std::filesystem::path& folder);

/// Whether the folder has runs of several seeds, also such on which every estimator failed.
bool holds_seeds(const std::filesystem::path& folder);

/// The page of a scenario that ran on several seeds (`aims run --seeds`): kind "suite", of that one
/// scenario. Error for scores that are broken.
Result<PageData> seeds_page(const std::filesystem::path& folder, const PageOptions& options);

/// The page of a suite's folder, finished or not: suite.json as it is, each run's scores with a
/// link to its own page where one lies there, the ROC curves of detectors.json, and the comparison
/// with other results. A run or a detectors.json of the folder itself that cannot be read becomes a
/// note on the page. Error when suite.json is not that of a suite, or when what `options` names
/// cannot be read.
Result<PageData> suite_page(const std::filesystem::path& folder, const PageOptions& options);

/// The page of the folder of `aims sweep` or `aims tune`, finished or not: every job with its
/// parameters and scores, and per estimator and score the best values of `aims merge`,
/// of which parameter matters, and of the curves and maps. Error when the folder is of neither.
Result<PageData> tuning_page(const std::filesystem::path& folder, const PageOptions& options);

/// The same of a source that was read; `folder`: where a tuning wrote what it came to.
Result<PageData> tuning_page(const TuningSource& source, const std::filesystem::path& folder);

}  // namespace aims
