// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "bench/run/scenario.hpp"
#include "core/error.hpp"
#include "render/film/filmed_sequence.hpp"

namespace aims {

/// Whether the folder is one that `aims run` writes for a seed.
bool holds_sequence(const std::filesystem::path& folder);

/// What the files of a run hold: trajectories, waypoint times, the scene (rebuilt from
/// config.yaml) and the final map of `mapped` (empty: of the first estimator that has one), whose
/// points all count as seen at the start. Joint angles are not in the files, so there is no
/// snapshot. The estimate that the map belongs to comes first. Error for a file that is missing or
/// broken.
Result<FilmedSequence> stored_sequence(const std::filesystem::path& folder,
                                       const std::string& mapped);

}  // namespace aims
