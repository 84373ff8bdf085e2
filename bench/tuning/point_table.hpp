// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "bench/tuning/sweep_summary.hpp"
#include "core/files/table.hpp"

namespace aims {

/// A row per estimator and point: the varied values, median and largest score over its runs that
/// have it, diverged runs. The default setting, where it was run, comes first.
TextTable point_table(std::span<const SweepResponse> responses, const std::string& score);

}  // namespace aims
