// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "core/error.hpp"
#include "render/page/page_data.hpp"

namespace aims {

/// Folders "seed-N" inside a folder of `aims run` that each hold a run, by seed.
std::vector<std::filesystem::path> seed_folders(const std::filesystem::path& folder);

/// Whether the folder has runs of several seeds, also such on which every estimator failed.
bool holds_seeds(const std::filesystem::path& folder);

/// The page of a scenario that ran on several seeds (`aims run --seeds`): kind "suite", of that one
/// scenario. Error for scores that are broken.
Result<PageData> seeds_page(const std::filesystem::path& folder, const PageOptions& options);

}  // namespace aims
