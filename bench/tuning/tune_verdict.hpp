// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/tuning/held_out.hpp"
#include "bench/tuning/tune.hpp"
#include "core/error.hpp"

namespace aims {

/// What the held-out sequences say of the chosen point, in the first objective.
PairedGain held_out_gain(const TuneResult& result);

/// What they say of the chosen point `chosen` of a Pareto front, in each objective.
std::vector<PairedGain> front_gains(const TuneResult& result, std::size_t chosen);

/// The values found and the verdict of the held-out sequences, a line each; of several objectives
/// the verdict alone, since there are several points. Expects a chosen point.
std::vector<std::string> verdict_lines(const TuneResult& result);

/// What they say in words, as `verdict_text`, or as `front_verdict` of several objectives; of a
/// tuning that was interrupted before them, so.
std::string held_out_verdict(const TuneResult& result);

/// What the held-out sequences say of a Pareto front, on one line: how many of its points are
/// better than the defaults, significantly in one objective and in none worse.
std::string front_verdict(const TuneResult& result);

/// Reads which held-out results were seen in `folder` before into `earlier_looks` and adds those of
/// this tuning, a line of held_out.txt for each.
Result<void> note_look(TuneResult& result, const std::filesystem::path& folder);

/// The held-out results that were seen in a folder, the last one too.
std::vector<std::string> looks_in(const std::filesystem::path& folder);

/// What so many earlier looks mean for the verdict.
std::string looks_text(std::size_t earlier);

}  // namespace aims
