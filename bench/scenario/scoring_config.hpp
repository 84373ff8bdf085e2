// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "bench/metrics/scores.hpp"
#include "core/error.hpp"

namespace aims {

/// How to score, by the group `scoring` of a YAML file (none: the defaults) with the settings
/// "scoring.key=value" on top. Any scenario, or the config.yaml of a run, may be given: the rest of
/// it is checked and left.
Result<ScoreConfig> scoring_config(const std::filesystem::path& file,
                                   std::span<const std::string> overrides);

}  // namespace aims
