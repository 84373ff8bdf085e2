// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>

#include "bench/scenario/scenario.hpp"
#include "bench/scoring/score_record.hpp"
#include "core/error.hpp"

namespace aims {

/// Writes summary.json, summary.csv and summary.md (the score table) of several seeds of a scenario
/// into `folder`.
Result<void> write_summary(const Scenario& scenario, std::span<const RunRecord> runs,
                           const std::filesystem::path& folder);

}  // namespace aims
