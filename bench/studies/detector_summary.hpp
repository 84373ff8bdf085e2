// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bench/studies/detectors.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"

namespace aims {

/// The pooled scores as a table: an index per row, and per level AUC with its interval, detections
/// at 5 % false alarms, median delay and missed onsets.
TextTable detector_table(std::span<const DetectorScore> scores);

/// Why some scores have no value, a line per level and set of runs that the truth never changes in.
std::vector<std::string> undecided_levels(std::span<const DetectorScore> scores);

/// Writes detectors.json, detectors.csv and detectors.md into `folder`.
Result<void> write_detectors(const DetectorStudy& study, const std::filesystem::path& folder);

}  // namespace aims
