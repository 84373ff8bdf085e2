// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/scoring/json_text.hpp"
#include "bench/tuning/tune.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"

namespace aims {

/// "90 different points in 8 generations of 10, seed 1".
std::string search_text(const TuneResult& result);

inline constexpr const char* kTuneFile = "tune.json";  ///< in the folder of a tuning

/// Schema aims.tune/1: objectives, verdict, and values and objectives of the defaults and of the
/// chosen points.
Json tune_json(const TuneResult& result);

/// "objective: ..." per objective, and what it is on the held-out sequences where that differs: the
/// defaults have a score of 0 there, or were lost.
std::vector<std::string> objective_lines(const TuneResult& result);

/// A row per part of the sequences, held out first: median score, diverged runs and objective of
/// the defaults and of the chosen point. Expects a chosen point.
TextTable outcome_table(const TuneResult& result);

/// A row per point of the front: its values and objectives, tuned and held out, and what the
/// held-out sequences say of it.
TextTable front_table(const TuneResult& result);

/// Writes tune.md, tune.json, tune.csv (every point) and tuned.yaml (of one objective) into
/// `folder`.
Result<void> write_tuning(const TuneResult& result, const std::filesystem::path& folder);

/// A line per sequence whose run is invalid, of those tuned on and those held out.
std::vector<std::string> left_out_lines(const TuneResult& result);

/// A line per sequence on which jobs failed, with the reason of one.
std::vector<std::string> failed_lines(const TuneResult& result);

/// The chosen point as a configuration file to be laid on top of any scenario (`--set @FILE`), with
/// where it comes from as comments: the held-out verdict first, sequences, algorithm, code, plan.
/// Expects one objective and a chosen point.
std::string overlay_text(const TuneResult& result);

/// Writes `overlay_text` to a file, whole or not at all.
Result<void> write_overlay(const TuneResult& result, const std::filesystem::path& file);

}  // namespace aims
