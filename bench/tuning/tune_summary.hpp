// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/tuning/response_summary.hpp"
#include "bench/tuning/tune.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"

namespace aims {

/// The chosen point as a configuration file to be laid on top of any scenario (`--set @FILE`), with
/// where it comes from as comments: objective before and after, sequences, algorithm, code, plan.
/// Expects one objective and a chosen point.
std::string overlay_text(const TuneResult& result);

/// Writes `overlay_text` to a file, whole or not at all.
Result<void> write_overlay(const TuneResult& result, const std::filesystem::path& file);

/// A row per part of the sequences: objective of the defaults, of the chosen point, and the gain.
TextTable outcome_table(const TuneResult& result);

/// A row per point of the front: its values and objectives, tuned and held out.
TextTable front_table(const TuneResult& result);

/// Writes tune.md, tune.csv (every point), tuned.yaml (of one objective) and pictures of the first
/// objective into `folder`. Pictures that cannot be drawn are named in `warnings`.
Result<void> write_tuning(const TuneResult& result, const std::filesystem::path& folder,
                          const DrawResponse& draw, std::vector<std::string>& warnings);

/// A line per sequence whose run is invalid, of those tuned on and those held out.
std::vector<std::string> left_out_lines(const TuneResult& result);

}  // namespace aims
