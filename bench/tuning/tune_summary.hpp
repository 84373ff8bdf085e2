// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bench/scoring/json_text.hpp"
#include "bench/tuning/held_out.hpp"
#include "bench/tuning/response_summary.hpp"
#include "bench/tuning/tune.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"

namespace aims {

/// "3 sequences: corridor, severity_5; seeds 1 2 3".
std::string sequences_text(std::span<const ScenarioSeed> sequences);

/// "90 different points in 8 generations of 10, seed 1".
std::string search_text(const TuneResult& result);

/// What the held-out sequences say of the chosen point, in the first objective.
PairedGain held_out_gain(const TuneResult& result);

/// The values found and the verdict of the held-out sequences, a line each; of several objectives
/// the verdict alone, since there are several points. Expects a chosen point.
std::vector<std::string> verdict_lines(const TuneResult& result);

/// What they say in words, as `verdict_text`, or as `front_verdict` of several objectives; of a
/// tuning that was interrupted before them, so.
std::string held_out_verdict(const TuneResult& result);

/// What the held-out sequences say of a Pareto front, on one line: how many of its points are
/// better than the defaults, significantly in one objective and in none worse.
std::string front_verdict(const TuneResult& result);

/// Schema aims.tune/1: objectives, verdict, and values and objectives of the defaults and of the
/// chosen points.
Json tune_json(const TuneResult& result);

/// A row per part of the sequences, held out first: median score, diverged runs and objective of
/// the defaults and of the chosen point. Expects a chosen point.
TextTable outcome_table(const TuneResult& result);

/// A row per point of the front: its values and objectives, tuned and held out, and what the
/// held-out sequences say of it.
TextTable front_table(const TuneResult& result);

/// Reads which held-out results were seen in `folder` before into `earlier_looks` and adds those of
/// this tuning, a line of held_out.txt for each.
Result<void> note_look(TuneResult& result, const std::filesystem::path& folder);

/// The held-out results that were seen in a folder, the last one too.
std::vector<std::string> looks_in(const std::filesystem::path& folder);

/// What so many earlier looks mean for the verdict.
std::string looks_text(std::size_t earlier);

/// Writes tune.md, tune.csv (every point) and tuned.yaml (of one objective) into `folder`.
Result<void> write_tuning(const TuneResult& result, const std::filesystem::path& folder);

/// A line per sequence whose run is invalid, of those tuned on and those held out.
std::vector<std::string> left_out_lines(const TuneResult& result);

/// A line per sequence on which jobs failed, with the reason of one.
std::vector<std::string> failed_lines(const TuneResult& result);

}  // namespace aims
